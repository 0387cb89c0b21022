#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "sessions/report/chart.h"
#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"
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
  tiles += Tile("Deepest", data.contacts.empty() ? "none" : Millimetres(data.deepest_mm));
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

std::string EpisodeRowColour(const ReportData& data, const core::ContactEpisode& episode) {
  const double fraction = data.deepest_mm > 0.0 ? episode.peak_depth_mm / data.deepest_mm : 0.0;
  return fmt::format("<span class='dot' style='background:{}'></span>", DepthColour(fraction));
}

std::string Moment(double time_s, core::FrameIndex frame) {
  return fmt::format("{:.2f} s <small>frame {}</small>", time_s, frame);
}

std::string SpacingTexts(const ReportData& data, const std::vector<double>& spacing_mm) {
  std::string text;
  for (std::size_t i = 0; i < spacing_mm.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : "<br>", Millimetres(spacing_mm[i]));
    if (data.spacings.size() > 1)
      text += " <small>" + Escaped(data.header.layout.spacings[i].name) + "</small>";
  }
  return text;
}

std::string ToolTexts(const std::vector<std::string>& tools) {
  std::string text;
  for (const std::string& tool : tools) text += (text.empty() ? "" : ", ") + Escaped(tool);
  return text.empty() ? "&ndash;" : text;
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

}  // namespace

std::string SummarySection(const ReportData& data) {
  const std::string gauge_failure = GaugeFailure(data.header.rig_quality);
  const bool is_doubtful = data.status != SessionStatus::kComplete || !gauge_failure.empty();
  const char* outcome = is_doubtful ? " broken" : data.contacts.empty() ? "" : " touched";
  std::string section = fmt::format("<section><div class='verdict{}'><p>{}</p>", outcome,
                                    WithUnitsHeld(Escaped(VerdictSentence(data))));
  if (!gauge_failure.empty()) section += "<p>" + WithUnitsHeld(Escaped(gauge_failure)) + "</p>";
  section += StatusRemark(data);
  return section + "</div>\n" + Tiles(data) + "</section>\n";
}

std::string TimelineSection(const ReportData& data) {
  if (data.frames.empty()) return "";
  return "<section><h2>Touches over time</h2><p class='lead'>A bar is one touch, from the first frame in "
         "contact to the "
         "last; the darker, the deeper.</p>\n" +
         TimelineChart(data) + "</section>\n";
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

std::string SpacingSection(const ReportData& data) {
  if (data.frames.empty() || data.spacings.empty()) return "";
  std::string section =
      "<section><h2>Spacing history</h2><p class='lead'>The spacing as the experimenter set it; times "
      "with any part in contact are shaded.</p>\n";
  for (const SpacingStudy& study : data.spacings) {
    const core::Spacing& spacing = data.header.layout.spacings[study.spacing];
    section += fmt::format("<h3>{}</h3><p class='lead'>Gap along {} from {} to {}, {} to {}.</p>\n",
                           Escaped(spacing.name), core::ToString(spacing.axis), Escaped(spacing.reference),
                           Escaped(spacing.moving), Millimetres(spacing.min_mm), Millimetres(spacing.max_mm));
    section += SpacingChart(data, study) + LevelTable(study);
  }
  return section + "</section>\n";
}

std::string EpisodeSection(const ReportData& data) {
  HtmlTable table({{"Touch", true},
                   {"Part"},
                   {"Begin", true},
                   {"Peak", true},
                   {"End", true},
                   {"Duration", true},
                   {"Depth <small>at peak</small>", true},
                   {"Area <small>at peak</small>", true},
                   {"Position <small>x, y, z in mm</small>", true},
                   {"Spacing <small>at peak</small>", true},
                   {"Tools"}});
  const auto worst = WorstEpisode(data.episodes);
  for (const core::ContactEpisode& e : data.episodes) {
    const Eigen::Vector3d& at = e.peak_position_in_world_mm;
    table.Add(
        {std::to_string(e.id), EpisodeRowColour(data, e) + Escaped(data.header.layout.parts[e.part].name),
         Moment(e.begin_time_s, e.begin_frame), Moment(e.peak_time_s, e.peak_frame),
         Moment(e.end_time_s, e.end_frame),
         fmt::format("{:.2f} s", e.end_time_s - e.begin_time_s + data.frame_period_s),
         Millimetres(e.peak_depth_mm), fmt::format("{:.0f} mm&sup2;", e.peak_area_mm2),
         fmt::format("{:.0f}, {:.0f}, {:.0f}", at.x(), at.y(), at.z()),
         SpacingTexts(data, e.spacing_at_peak_mm), ToolTexts(e.tools)},
        worst->id == e.id ? "worst" : "");
  }
  if (table.empty()) return "";
  return "<section><h2>Every touch</h2><p class='lead'>The deepest one is highlighted.</p>\n" + table.Html() +
         "</section>\n";
}

std::string NearMissSection(const ReportData& data) {
  HtmlTable table({{"Near miss", true},
                   {"Part"},
                   {"Begin", true},
                   {"Closest", true},
                   {"End", true},
                   {"Clearance <small>at least, at most</small>", true},
                   {"Position <small>x, y, z in mm, on the part</small>", true},
                   {"Spacing <small>at closest</small>", true},
                   {"Tools"},
                   {"Below"}});
  for (const core::NearMiss& miss : data.near_misses) {
    const core::ClearanceInterval& closest = miss.closest.interval;
    const Eigen::Vector3d& at = closest.witness_part_in_world_mm;
    table.Add({std::to_string(miss.id), Escaped(data.header.layout.parts[miss.part].name),
               Moment(miss.begin_time_s, miss.begin_frame), Moment(miss.closest_time_s, miss.closest_frame),
               Moment(miss.end_time_s, miss.end_frame),
               miss.closest.has_witnesses
                   ? fmt::format("{} to {}", Millimetres(closest.lower_mm), Millimetres(closest.upper_mm))
                   : "at least " + Millimetres(closest.lower_mm),
               miss.closest.has_witnesses ? fmt::format("{:.0f}, {:.0f}, {:.0f}", at.x(), at.y(), at.z())
                                          : "&ndash;",
               SpacingTexts(data, miss.spacing_at_closest_mm), ToolTexts(miss.tools),
               miss.verdict == core::Verdict::kNear ? "yes" : "undecided"});
  }
  if (table.empty()) return "";
  return fmt::format(
      "<section><h2>Near misses</h2><p class='lead'>Approaches below the required {} that ended without a "
      "touch. The real distance may be larger: the hull is larger than the hand.</p>\n{}</section>\n",
      Millimetres(data.header.trial.required_clearance_mm), table.Html());
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
