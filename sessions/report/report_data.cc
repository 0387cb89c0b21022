#include "sessions/report/report_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <variant>

#include "core/error.h"
#include "core/procedure/tools_in_use.h"
#include "sessions/report/frame_touches.h"

namespace elbowroom::sessions {
namespace {

double DurationOf(const ReportData& data, std::size_t frame) {
  return EndOf(data, frame) - data.frames[frame].time_s;
}

void MeasureTime(ReportData& data) {
  if (data.frames.empty()) return;
  data.begin_s = data.frames.front().time_s;
  const double last_s = data.frames.back().time_s;
  if (data.frames.size() > 1)
    data.frame_period_s = (last_s - data.begin_s) / static_cast<double>(data.frames.size() - 1);
  data.end_s = last_s + data.frame_period_s;
  data.columns = {data.begin_s, std::max(data.end_s, data.begin_s + 1e-3),
                  std::min(data.frames.size(), kMostColumns)};
}

double DepthOf(const ContactRow& row) { return row.contact.deepest ? row.contact.deepest->depth_mm : 0.0; }

template <typename Change>
void ChangeColumns(const ReportData& data, std::size_t frame, PartSummary& part, const Change& change) {
  const ColumnRange range = data.columns.Of(data.frames[frame].time_s, EndOf(data, frame));
  for (std::size_t i = range.first; i < range.end; ++i) change(part.columns[i]);
}

void AddContact(ReportData& data, FrameTouches& touches, const ContactRow& row) {
  const double depth_mm = DepthOf(row);
  const std::size_t frame = touches.Add(row.frame, row.contact.part, depth_mm);
  PartSummary& part = data.parts[row.contact.part];
  part.in_contact_s += DurationOf(data, frame);
  part.deepest_mm = std::max(part.deepest_mm, depth_mm);
  data.deepest_mm = std::max(data.deepest_mm, depth_mm);
  ChangeColumns(data, frame, part, [&](PartColumn& column) {
    column.deepest_mm = std::max(column.deepest_mm.value_or(0.0), depth_mm);
  });
}

void AddClearance(ReportData& data, std::size_t frame, const ContactRow& row) {
  const core::ClearanceInterval& interval = row.contact.clearance->interval;
  if (!std::isfinite(interval.upper_mm)) return;
  PartSummary& part = data.parts[row.contact.part];
  if (!part.closest || interval.upper_mm < part.closest->upper_mm)
    part.closest = {row.frame, row.time_s, interval.lower_mm, interval.upper_mm, row.spacing_mm};
  ChangeColumns(data, frame, part, [&](PartColumn& column) {
    if (column.closest_lower_mm && column.closest_upper_mm <= interval.upper_mm) return;
    column.closest_lower_mm = interval.lower_mm;
    column.closest_upper_mm = interval.upper_mm;
  });
}

// The levels of the frames that `counts` says.
template <typename Counts>
SpaceNeed NeedOf(const ReportData& data, const FrameTouches& touches, core::SpacingIndex spacing,
                 const Counts& counts) {
  std::map<double, SpacingLevel> levels;
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    if (!counts(i)) continue;
    SpacingLevel& level = levels[data.frames[i].spacing_mm[spacing]];
    level.spacing_mm = data.frames[i].spacing_mm[spacing];
    level.held_s += DurationOf(data, i);
    ++level.frames;
    const std::optional<double> depth_mm = touches.DepthAt(i, spacing);
    if (!depth_mm) continue;
    ++level.frames_in_contact;
    level.deepest_mm = std::max(level.deepest_mm, *depth_mm);
  }
  SpaceNeed need;
  for (const auto& [spacing_mm, level] : levels) {
    need.levels.push_back(level);
    if (level.frames_in_contact > 0) {
      need.largest_touched_mm = spacing_mm;
      need.smallest_free_mm.reset();
    } else if (!need.smallest_free_mm && level.held_s >= kTriedFor_s) {
      need.smallest_free_mm = spacing_mm;
    }
  }
  return need;
}

void CountTouches(const ReportData& data, SpacingStudy& study) {
  for (const core::ContactEpisode& episode : data.episodes) {
    if (!IsBoundedBy(data.header.layout, episode.part, study.spacing)) continue;
    const auto level = std::ranges::find(study.levels, episode.spacing_at_peak_mm.at(study.spacing),
                                         &SpacingLevel::spacing_mm);
    if (level != study.levels.end()) ++level->touches;
  }
}

// Which tools are in use in each frame: bit i is the tool i.
std::vector<std::uint64_t> ToolsInUse(const ReportData& data, const std::vector<std::string>& tools) {
  std::vector<std::uint64_t> in_use(data.frames.size(), 0);
  core::ToolsOfFrames tools_of_frames(data.events);
  for (std::size_t i = 0; i < data.frames.size(); ++i)
    for (const std::string& name : tools_of_frames.At(data.frames[i].frame)) {
      const auto tool = std::ranges::find(tools, name);
      if (tool != tools.end()) in_use[i] |= std::uint64_t{1} << static_cast<unsigned>(tool - tools.begin());
    }
  return in_use;
}

SpacingStudy StudyOf(const ReportData& data, const FrameTouches& touches, core::SpacingIndex spacing) {
  constexpr std::size_t kMostTools = 16;  // of a page's table
  SpacingStudy study{NeedOf(data, touches, spacing, [](std::size_t) { return true; }), spacing, {}, {}};
  for (const FrameSummary& frame : data.frames) {
    const double spacing_mm = frame.spacing_mm[spacing];
    if (study.steps.empty() || study.steps.back().spacing_mm != spacing_mm)
      study.steps.push_back({frame.time_s, spacing_mm});
  }
  CountTouches(data, study);
  std::vector<std::string> tools = ToolsMarked(data);
  if (tools.size() > kMostTools) tools.resize(kMostTools);
  if (tools.empty()) return study;
  const std::vector<std::uint64_t> in_use = ToolsInUse(data, tools);
  study.by_tool.push_back(
      {"", NeedOf(data, touches, spacing, [&](std::size_t i) { return in_use[i] == 0; })});
  for (std::size_t tool = 0; tool < tools.size(); ++tool)
    study.by_tool.push_back({tools[tool], NeedOf(data, touches, spacing, [&](std::size_t i) {
                               return (in_use[i] >> tool & 1U) != 0;
                             })});
  return study;
}

std::optional<core::SpacingIndex> SpacingToJudge(const std::vector<SpacingStudy>& studies) {
  if (studies.empty()) return std::nullopt;
  const auto moved = std::ranges::find_if(studies, [](const SpacingStudy& s) { return s.levels.size() > 1; });
  return moved != studies.end() ? moved->spacing : studies.front().spacing;
}

ReportData DataWithoutRows(const SessionReader& session) {
  ReportData data;
  data.session_name = session.path().filename().string();
  data.header = session.header();
  data.status = session.status();
  data.has_outcome = session.has_outcome();
  data.ended_at_utc = session.ended_at_utc();
  data.frames = session.frames();
  data.events = session.events();
  data.episodes = session.episodes();
  data.list = TouchesOf(session);
  data.near_misses = data.list.touches.size() + data.list.left_out - data.episodes.size();
  data.stamps = session.stamp_rows();
  data.budgets = session.part_budgets();
  MeasureTime(data);
  for (const PartTotals& totals : session.part_totals())
    data.parts.push_back(
        {totals, 0, 0.0, 0.0, std::nullopt, std::vector<PartColumn>(data.columns.count, PartColumn())});
  for (const core::ContactEpisode& episode : data.episodes) ++data.parts[episode.part].touches;
  return data;
}

}  // namespace

double EndOf(const ReportData& data, std::size_t frame) {
  return frame + 1 < data.frames.size() ? data.frames[frame + 1].time_s
                                        : data.frames[frame].time_s + data.frame_period_s;
}

double SpaceNeed::held_s() const {
  double sum_s = 0.0;
  for (const SpacingLevel& level : levels) sum_s += level.held_s;
  return sum_s;
}

bool ReportData::has_clearance() const {
  return std::ranges::any_of(parts, [](const PartSummary& part) { return part.closest.has_value(); });
}

bool IsBoundedBy(const core::Layout& layout, core::PartIndex part, core::SpacingIndex spacing) {
  const core::Spacing& gap = layout.spacings[spacing];
  return std::ranges::any_of(std::array{&gap.moving, &gap.reference}, [&](const std::string* name) {
    return std::ranges::count(layout.PartsNamed(*name), part) > 0;
  });
}

std::vector<std::string> ToolsMarked(const ReportData& data) {
  std::vector<std::string> tools;
  for (const core::SessionEvent& event : data.events) {
    const auto* mark = std::get_if<core::ToolMarked>(&event.what);
    if (mark != nullptr && std::ranges::find(tools, mark->tool) == tools.end()) tools.push_back(mark->tool);
  }
  return tools;
}

ReportData CollectReportData(const SessionReader& session, const RowVisitor& on_contact,
                             const RowVisitor& on_clearance) {
  ReportData data = DataWithoutRows(session);
  FrameTouches touches(data.frames, data.header.layout);
  FramePlaces places(data.frames);
  session.VisitRows(
      [&](const ContactRow& row) {
        AddContact(data, touches, row);
        if (on_contact) on_contact(row);
      },
      [&](const ContactRow& row) {
        AddClearance(data, places.Of(row.frame), row);
        if (on_clearance) on_clearance(row);
      });
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    if (!touches.IsTouched(i)) continue;
    ++data.frames_in_contact;
    data.in_contact_s += DurationOf(data, i);
  }
  for (core::SpacingIndex i = 0; i < data.header.layout.spacings.size(); ++i)
    data.spacings.push_back(StudyOf(data, touches, i));
  data.judged_spacing = SpacingToJudge(data.spacings);
  return data;
}

}  // namespace elbowroom::sessions
