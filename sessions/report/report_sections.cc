#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "sessions/report/approach_chart.h"
#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"
#include "sessions/report/page_charts.h"
#include "sessions/report/report_page.h"
#include "sessions/report/timeline_chart.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

// A spacing with more values than this was moved by a slider: only the values held longest are listed.
constexpr std::size_t kMostLevels = 16;

// Keeps "240 mm" on one line.
std::string WithUnitsHeld(std::string html) {
  for (std::size_t at = 0; (at = html.find(" mm", at)) != std::string::npos;) html.replace(at, 1, "&nbsp;");
  return html;
}

std::string Tile(const std::string& title, const std::string& value, const std::string& remark = "") {
  return fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>", title, value, remark);
}

std::string Tiles(const ReportData& data) {
  const double duration_s = data.end_s - data.begin_s;
  const core::TrialInfo& trial = data.header.trial;
  std::string tiles;
  if (data.has_outcome) {
    tiles += Tile("Touches", std::to_string(data.episodes.size()), Escaped(TouchesByPart(data)));
  }
  tiles += Tile(
      "Time in contact", fmt::format("{:.1f} s", data.in_contact_s),
      duration_s > 0.0 ? fmt::format("{:.0f} % of the trial", 100.0 * data.in_contact_s / duration_s) : "");
  tiles += Tile("Deepest", data.has_contact() ? Millimetres(data.deepest_mm) : "none");
  if (data.judged_spacing) {
    tiles += Tile("Space needed", SpaceNeeded(data),
                  Escaped(data.header.layout.spacings[*data.judged_spacing].name));
  }
  tiles += Tile("Participant&rsquo;s estimate",
                trial.estimate_mm > 0.0 ? Millimetres(trial.estimate_mm) : "none given");
  if (trial.required_clearance_mm > 0.0) {
    tiles +=
        Tile("Required clearance", Millimetres(trial.required_clearance_mm), "not part of the space needed");
  }
  return "<dl class='tiles'>" + tiles + "</dl>\n";
}

std::string LevelTable(const SpacingStudy& study) {
  std::vector<SpacingLevel> levels = study.levels;
  if (levels.size() > kMostLevels) {
    std::ranges::stable_sort(levels, std::ranges::greater(), &SpacingLevel::held_s);
    levels.resize(kMostLevels);
    std::ranges::sort(levels, {}, &SpacingLevel::spacing_mm);
  }
  HtmlTable table({{"Spacing", true},
                   {"Held", true},
                   {"Touches <small>deepest there</small>", true},
                   {"Frames in contact", true},
                   {"Deepest", true},
                   {"Outcome"}});
  for (const SpacingLevel& level : levels) {
    const bool is_touched = level.frames_in_contact > 0;
    const char* outcome = is_touched                    ? "touched"
                          : level.held_s >= kTriedFor_s ? "free of touches"
                                                        : "only passed";
    table.Add({Millimetres(level.spacing_mm), fmt::format("{:.1f} s", level.held_s),
               std::to_string(level.touches), fmt::format("{} of {}", level.frames_in_contact, level.frames),
               is_touched ? Millimetres(level.deepest_mm) : "&ndash;", outcome});
  }
  const std::size_t left_out = study.levels.size() - levels.size();
  return table.Html() +
         (left_out > 0
              ? fmt::format("<p class='lead'>{} more values, held shorter, are not listed.</p>\n", left_out)
              : "");
}

std::string WhatHappened(const core::SessionEvent& event) {
  if (const auto* change = std::get_if<core::SpacingChanged>(&event.what)) {
    return fmt::format("{} from {} to <b>{}</b>", Escaped(change->spacing), Millimetres(change->from_mm),
                       Millimetres(change->to_mm));
  }
  if (const auto* mark = std::get_if<core::ToolMarked>(&event.what)) {
    return Escaped(mark->tool) + (mark->in_use ? " taken in use" : " put away");
  }
  return Escaped(std::get<core::Note>(event.what).text);
}

std::string Figure(std::span<const unsigned char> png, const std::string& caption,
                   const std::string& alternative) {
  return fmt::format("<figure><img alt='{}' src='{}'><figcaption>{}</figcaption></figure>\n", alternative,
                     PngAsDataUrl(png), Escaped(caption));
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
          "<p>This session is still being recorded: what follows covers the frames on disk when "
          "the report was written; {}.</p>",
          touches);
    case SessionStatus::kCutOff:
    case SessionStatus::kAbandoned:
      return fmt::format(
          "<p>This session was not ended properly: what follows covers the frames up to the last "
          "one on disk; {}.</p>",
          touches);
  }
  return "";
}

// What each tool needs; empty where no tool was marked.
std::string ToolNeedTable(const SpacingStudy& study) {
  HtmlTable table({{"In use"}, {"For", true}, {"Touched up to", true}, {"Free of touches from", true}});
  const auto length = [](const std::optional<double>& length_mm) {
    return length_mm ? Millimetres(*length_mm) : std::string("&ndash;");
  };
  for (const ToolNeed& tool : study.by_tool)
    table.Add({tool.tool.empty() ? "no tool" : "<bdi>" + Escaped(tool.tool) + "</bdi>",
               fmt::format("{:.1f} s", tool.need.held_s()), length(tool.need.largest_touched_mm),
               length(tool.need.smallest_free_mm)});
  return table.empty() ? "" : table.Html();
}

}  // namespace

std::string SummarySection(const ReportData& data) {
  const std::string gauge_failure = GaugeFailure(data.header.rig_quality);
  const bool is_doubtful = data.status != SessionStatus::kComplete || !gauge_failure.empty();
  const char* outcome = is_doubtful ? " broken" : data.has_contact() ? " touched" : "";
  std::string section = fmt::format("<section><div class='verdict{}'><p>{}</p>", outcome,
                                    WithUnitsHeld(Escaped(VerdictSentence(data))));
  if (!gauge_failure.empty()) section += "<p>" + WithUnitsHeld(Escaped(gauge_failure)) + "</p>";
  section += StatusRemark(data);
  return section + "</div>\n" + Tiles(data) + "</section>\n";
}

std::string TimelineSection(const ReportData& data, PageCharts* charts) {
  if (data.frames.empty()) return "";
  return "<section><h2>Touches over time</h2><p class='lead'>A bar is one touch, from the first frame in "
         "contact to the "
         "last; the darker, the deeper: " +
         Millimetres(DarkestDepth(data)) + " is the darkest.</p>\n" + charts->Add(TimelineChart(data)) +
         "</section>\n";
}

std::string PictureSection(const ReportPictures& pictures) {
  std::string figures;
  if (!pictures.worst_moment_png.empty())
    figures += Figure(pictures.worst_moment_png, pictures.caption, "The worst moment");
  if (pictures.overview_png) {
    figures += Figure(*pictures.overview_png, "Overview of the parts and the real objects.", "Overview");
  }
  if (figures.empty()) return "";
  return fmt::format("<section><h2>{}</h2>\n{}</section>\n",
                     pictures.worst_moment_png.empty() ? "Overview" : "The worst moment", figures);
}

std::string ApproachSection(const ReportData& data, PageCharts* charts) {
  if (!data.has_clearance()) return "";
  const auto shown = std::min<std::ptrdiff_t>(
      std::ranges::count_if(data.parts, [](const PartSummary& part) { return part.closest.has_value(); }),
      kMostApproaches);
  HtmlTable table({{"Part"},
                   {"Closest <small>at least, at most</small>", true},
                   {"When", true},
                   {"Spacing <small>then</small>", true}});
  for (const PartSummary& part : data.parts) {
    if (!part.closest) continue;
    table.Add(
        {"<bdi>" + Escaped(data.header.layout.parts[part.frames.part].name) + "</bdi>",
         fmt::format("{} to {}", Millimetres(part.closest->lower_mm), Millimetres(part.closest->upper_mm)),
         fmt::format("{:.2f} s <small>frame {}</small>", part.closest->time_s, part.closest->frame),
         SpacingTexts(data, part.closest->spacing_mm)});
  }
  return fmt::format(
             "<section><h2>Closest approach</h2><p class='lead'>Bounds of the distance between a part and "
             "the "
             "hull, the closest of each moment; the real distance may be larger. Drawn for {} of {} parts, "
             "those that came closest.</p>\n",
             shown, data.parts.size()) +
         charts->Add(ApproachChart(data)) + table.Html() + "</section>\n";
}

std::string SpacingSection(const ReportData& data, PageCharts* charts) {
  if (data.frames.empty() || data.spacings.empty()) return "";
  std::string section =
      "<section><h2>Spacing history</h2><p class='lead'>The spacing as the experimenter set it; times "
      "with any part in contact are shaded.</p>\n";
  for (const SpacingStudy& study : data.spacings) {
    const core::Spacing& spacing = data.header.layout.spacings[study.spacing];
    section += fmt::format("<h3>{}</h3><p class='lead'>Gap along {} from {} to {}, {} to {}.</p>\n",
                           Escaped(spacing.name), core::ToString(spacing.axis), Escaped(spacing.reference),
                           Escaped(spacing.moving), Millimetres(spacing.min_mm), Millimetres(spacing.max_mm));
    section += charts->Add(SpacingChart(data, study)) + LevelTable(study) + ToolNeedTable(study);
  }
  return section + "</section>\n";
}

std::string HeatSection(const ReportData& data, const ReportPictures& pictures) {
  std::string figures;
  for (const ReportPictures::Heat& heat : pictures.heat) {
    const std::string& name = data.header.layout.parts[heat.part].name;
    figures += Figure(heat.png,
                      fmt::format("{}: how long and how deep each patch of about {:.0f} mm was touched.",
                                  name, core::kHeatPatchMm),
                      "Where the part was touched");
  }
  if (figures.empty()) return "";
  return "<section><h2>Where parts were touched</h2>\n" + figures + "</section>\n";
}

// How parts that give way were judged.
std::string GivesWayNotes(const core::Layout& layout) {
  std::string notes;
  for (const core::Part& part : layout.parts) {
    if (std::holds_alternative<core::ClothRule>(part.gives_way))
      notes += fmt::format("<p>{} hangs as cloth: judged in its shape at rest.</p>\n", Escaped(part.name));
    if (std::holds_alternative<core::PushRule>(part.gives_way))
      notes += fmt::format("<p>{} moves out of the way: judged where each frame found it.</p>\n",
                           Escaped(part.name));
  }
  return notes;
}

std::string PartSection(const ReportData& data) {
  HtmlTable table({{"Part"},
                   {"Touches", true},
                   {"In contact", true},
                   {"Deepest", true},
                   {"Frames in contact", true},
                   {"near", true},
                   {"undecided", true},
                   {"clear", true}});
  for (const PartSummary& part : data.parts) {
    const bool is_touched = part.frames.frames_in_contact > 0;
    table.Add({Escaped(data.header.layout.parts[part.frames.part].name), std::to_string(part.touches),
               is_touched ? fmt::format("{:.1f} s", part.in_contact_s) : "&ndash;",
               is_touched ? Millimetres(part.deepest_mm) : "&ndash;",
               std::to_string(part.frames.frames_in_contact), std::to_string(part.frames.frames_near),
               std::to_string(part.frames.frames_undecided), std::to_string(part.frames.frames_clear)});
  }
  if (table.empty()) return "";
  return "<section><h2>Parts</h2>\n" + table.Html() + GivesWayNotes(data.header.layout) + "</section>\n";
}

std::string EventSection(const ReportData& data) {
  HtmlTable table({{"Time", true}, {"Frame", true}, {"What happened"}});
  for (const core::SessionEvent& event : data.events) {
    table.Add({fmt::format("{:.2f} s", event.time_s), std::to_string(event.frame), WhatHappened(event)});
  }
  return table.empty() ? "" : "<section><h2>Events</h2>\n" + table.Html() + "</section>\n";
}

}  // namespace elbowroom::sessions
