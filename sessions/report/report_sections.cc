#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "core/procedure/event_text.h"
#include "sessions/report/approach_chart.h"
#include "sessions/report/report_document.h"
#include "sessions/report/timeline_chart.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

// A spacing with more values than this was moved by a slider: only the values held longest are listed.
constexpr std::size_t kMostLevels = 16;

void AddLevels(const SpacingStudy& study, std::vector<Block>* blocks) {
  std::vector<SpacingLevel> levels = study.levels;
  if (levels.size() > kMostLevels) {
    std::ranges::stable_sort(levels, std::ranges::greater(), &SpacingLevel::held_s);
    levels.resize(kMostLevels);
    std::ranges::sort(levels, {}, &SpacingLevel::spacing_mm);
  }
  DocumentTable table{{{"Spacing", true},
                       {"Held", true},
                       {WithRemark("Touches", "deepest there"), true},
                       {"Frames in contact", true},
                       {"Deepest", true},
                       {"Outcome"}},
                      {}};
  for (const SpacingLevel& level : levels) {
    const bool is_touched = level.frames_in_contact > 0;
    const char* outcome = is_touched                    ? "touched"
                          : level.held_s >= kTriedFor_s ? "free of touches"
                                                        : "only passed";
    table.rows.push_back(
        {{Millimetres(level.spacing_mm), fmt::format("{:.1f} s", level.held_s), std::to_string(level.touches),
          fmt::format("{} of {}", level.frames_in_contact, level.frames),
          is_touched ? Millimetres(level.deepest_mm) : kNothing, outcome}});
  }
  blocks->push_back(std::move(table));
  const std::size_t left_out = study.levels.size() - levels.size();
  if (left_out > 0)
    blocks->push_back(
        Paragraph{fmt::format("{} more values, held shorter, are not listed.", left_out), true});
}

RichText WhatHappened(const core::SessionEvent& event) {
  if (const auto* change = std::get_if<core::SpacingChanged>(&event.what)) {
    RichText text = fmt::format("{} from {} to ", change->spacing, Millimetres(change->from_mm));
    text += Strong(Millimetres(change->to_mm));
    return text;
  }
  return core::EventText(event.what);
}

// The remark on a session that isn't complete.
std::string StatusRemark(const ReportData& data) {
  const char* touches = data.has_outcome ? "touches are put together from these frames"
                                         : "contacts are not merged into touches";
  switch (data.status) {
    case SessionStatus::kComplete:
      return "";
    case SessionStatus::kRecording:
      return fmt::format(
          "This session is still being recorded: what follows covers the frames on disk when the report was "
          "written; {}.",
          touches);
    case SessionStatus::kCutOff:
    case SessionStatus::kAbandoned:
      return fmt::format(
          "This session was not ended properly: what follows covers the frames up to the last one on disk; "
          "{}.",
          touches);
  }
  return "";
}

// What each tool needs; nothing where no tool was marked.
void AddToolNeeds(const SpacingStudy& study, std::vector<Block>* blocks) {
  DocumentTable table{{{"In use"}, {"For", true}, {"Touched up to", true}, {"Free of touches from", true}},
                      {}};
  const auto length = [](const std::optional<double>& length_mm) {
    return length_mm ? Millimetres(*length_mm) : std::string(kNothing);
  };
  for (const ToolNeed& tool : study.by_tool) {
    table.rows.push_back(
        {{tool.tool.empty() ? "no tool" : NameText(tool.tool), fmt::format("{:.1f} s", tool.need.held_s()),
          length(tool.need.largest_touched_mm), length(tool.need.smallest_free_mm)}});
  }
  if (!table.rows.empty()) blocks->push_back(std::move(table));
}

// How parts that give way were judged.
void AddGivesWayNotes(const core::Layout& layout, std::vector<Block>* blocks) {
  for (const core::Part& part : layout.parts) {
    if (std::holds_alternative<core::ClothRule>(part.gives_way))
      blocks->push_back(Paragraph{part.name + " hangs as cloth: judged in its shape at rest."});
    if (std::holds_alternative<core::PushRule>(part.gives_way))
      blocks->push_back(Paragraph{part.name + " moves out of the way: judged where each frame found it."});
  }
}

DocumentTable ApproachTable(const ReportData& data) {
  DocumentTable table{{{"Part"},
                       {WithRemark("Closest", "at least, at most"), true},
                       {"When", true},
                       {WithRemark("Spacing", "then"), true}},
                      {}};
  for (const PartSummary& part : data.parts) {
    if (!part.closest) continue;
    table.rows.push_back(
        {{NameText(data.header.layout.parts[part.frames.part].name),
          fmt::format("{} to {}", Millimetres(part.closest->lower_mm), Millimetres(part.closest->upper_mm)),
          WithRemark(fmt::format("{:.2f} s", part.closest->time_s),
                     fmt::format("frame {}", part.closest->frame)),
          SpacingTexts(data, part.closest->spacing_mm)}});
  }
  return table;
}

}  // namespace

Section SummarySection(const ReportData& data) {
  const std::string gauge_failure = GaugeFailure(data.header.rig_quality);
  const std::string status_remark = StatusRemark(data);
  const bool is_doubtful = !status_remark.empty() || !gauge_failure.empty();
  Verdict verdict;
  verdict.outcome = is_doubtful          ? Verdict::Outcome::kDoubtful
                    : data.has_contact() ? Verdict::Outcome::kTouched
                                         : Verdict::Outcome::kFree;
  verdict.paragraphs = {VerdictSentence(data)};
  for (const std::string& remark : {gauge_failure, status_remark})
    if (!remark.empty()) verdict.paragraphs.push_back(remark);
  return {.blocks = {std::move(verdict), TilesOf(data)}};
}

Section TimelineSection(const ReportData& data, ChartPainters* painters) {
  if (data.frames.empty()) return {};
  const std::string lead =
      "A bar is one touch, from the first frame in contact to the last; the darker, the deeper: " +
      Millimetres(DarkestDepth(data)) + " is the darkest.";
  return {
      .blocks = {Heading{"Touches over time"}, Paragraph{lead, true}, Drawn(TimelineChart(data), painters)}};
}

Section PictureSection(const ReportPictures& pictures) {
  Section section;
  if (!pictures.worst_moment_png.empty())
    section.blocks = {Heading{"The worst moment"},
                      Picture{pictures.worst_moment_png, pictures.caption, "The worst moment"}};
  if (!pictures.overview_png) return section;
  if (section.blocks.empty()) section.blocks = {Heading{"Overview"}};
  section.blocks.push_back(
      Picture{*pictures.overview_png, "Overview of the parts and the real objects.", "Overview"});
  return section;
}

Section ApproachSection(const ReportData& data, ChartPainters* painters) {
  if (!data.has_clearance()) return {};
  const auto shown = std::min<std::ptrdiff_t>(
      std::ranges::count_if(data.parts, [](const PartSummary& part) { return part.closest.has_value(); }),
      kMostApproaches);
  const std::string lead = fmt::format(
      "Bounds of the distance between a part and the hull, the closest of each moment; the real distance may "
      "be larger. Drawn for {} of {} parts, those that came closest.",
      shown, data.parts.size());
  return {.blocks = {Heading{"Closest approach"}, Paragraph{lead, true}, Drawn(ApproachChart(data), painters),
                     ApproachTable(data)}};
}

Section SpacingSection(const ReportData& data, ChartPainters* painters) {
  if (data.frames.empty() || data.spacings.empty()) return {};
  Section section{.blocks = {Heading{"Spacing history"},
                             Paragraph{"The spacing as the experimenter set it; times with any part in "
                                       "contact are shaded.",
                                       true}}};
  for (const SpacingStudy& study : data.spacings) {
    const core::Spacing& spacing = data.header.layout.spacings[study.spacing];
    section.blocks.push_back(Heading{spacing.name, true});
    RichText gap = fmt::format("Gap along {} from ", core::ToString(spacing.axis));
    gap += NameRun(spacing.reference);
    gap += {.text = " to "};
    gap += NameRun(spacing.moving);
    gap += {.text = fmt::format(", {} to {}.", Millimetres(spacing.min_mm), Millimetres(spacing.max_mm))};
    section.blocks.push_back(Paragraph{std::move(gap), true});
    section.blocks.push_back(Drawn(SpacingChart(data, study), painters));
    AddLevels(study, &section.blocks);
    AddToolNeeds(study, &section.blocks);
  }
  return section;
}

Section HeatSection(const ReportData& data, const ReportPictures& pictures) {
  Section section;
  for (const ReportPictures::Heat& heat : pictures.heat) {
    if (section.blocks.empty()) section.blocks = {Heading{"Where parts were touched"}};
    section.blocks.push_back(
        Picture{heat.png,
                fmt::format("{}: how long and how deep each patch of about {:.0f} mm was touched.",
                            data.header.layout.parts[heat.part].name, core::kHeatPatchMm),
                "Where the part was touched"});
  }
  return section;
}

Section PartSection(const ReportData& data) {
  DocumentTable table{{{"Part"},
                       {"Touches", true},
                       {"In contact", true},
                       {"Deepest", true},
                       {"Frames in contact", true},
                       {"near", true},
                       {"undecided", true},
                       {"clear", true}},
                      {}};
  for (const PartSummary& part : data.parts) {
    const bool is_touched = part.frames.frames_in_contact > 0;
    table.rows.push_back(
        {{data.header.layout.parts[part.frames.part].name, std::to_string(part.touches),
          is_touched ? fmt::format("{:.1f} s", part.in_contact_s) : kNothing,
          is_touched ? Millimetres(part.deepest_mm) : kNothing, std::to_string(part.frames.frames_in_contact),
          std::to_string(part.frames.frames_near), std::to_string(part.frames.frames_undecided),
          std::to_string(part.frames.frames_clear)}});
  }
  if (table.rows.empty()) return {};
  Section section{.blocks = {Heading{"Parts"}, std::move(table)}};
  AddGivesWayNotes(data.header.layout, &section.blocks);
  return section;
}

Section EventSection(const ReportData& data) {
  DocumentTable table{{{"Time", true}, {"Frame", true}, {"What happened"}}, {}};
  for (const core::SessionEvent& event : data.events)
    table.rows.push_back(
        {{fmt::format("{:.2f} s", event.time_s), std::to_string(event.frame), WhatHappened(event)}});
  if (table.rows.empty()) return {};
  return {.blocks = {Heading{"Events"}, std::move(table)}};
}

}  // namespace elbowroom::sessions
