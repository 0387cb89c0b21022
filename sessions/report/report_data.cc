#include "sessions/report/report_data.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace elbowroom::sessions {
namespace {

// Frames of a trial need not be evenly spaced: each lasts until the next.
double DurationOf(const ReportData& data, std::size_t frame) {
  return frame + 1 < data.frames.size() ? data.frames[frame + 1].time_s - data.frames[frame].time_s
                                        : data.frame_period_s;
}

void MeasureTime(ReportData& data) {
  if (data.frames.empty()) return;
  data.begin_s = data.frames.front().time_s;
  const double last_s = data.frames.back().time_s;
  if (data.frames.size() > 1)
    data.frame_period_s = (last_s - data.begin_s) / static_cast<double>(data.frames.size() - 1);
  data.end_s = last_s + data.frame_period_s;
}

double DepthOf(const ContactRow& row) { return row.contact.deepest ? row.contact.deepest->depth_mm : 0.0; }

// The deepest contact of each frame that has one.
std::map<core::FrameIndex, double> DepthByFrame(const ReportData& data, core::SpacingIndex spacing) {
  std::map<core::FrameIndex, double> depth_mm;
  for (const ContactRow& row : data.contacts) {
    if (!IsBoundedBy(data, row.contact.part, spacing)) continue;
    double& deepest = depth_mm[row.frame];
    deepest = std::max(deepest, DepthOf(row));
  }
  return depth_mm;
}

void SumUpParts(const SessionReader& session, ReportData& data) {
  data.budgets = session.part_budgets();
  for (const PartTotals& totals : session.part_totals()) data.parts.push_back({totals, 0, 0.0, 0.0});
  for (const core::ContactEpisode& episode : data.episodes) ++data.parts[episode.part].touches;
  std::map<core::FrameIndex, double> duration_s;
  for (std::size_t i = 0; i < data.frames.size(); ++i) duration_s[data.frames[i].frame] = DurationOf(data, i);
  std::set<core::FrameIndex> touched;
  for (const ContactRow& row : data.contacts) {
    PartSummary& part = data.parts[row.contact.part];
    part.in_contact_s += duration_s[row.frame];
    part.deepest_mm = std::max(part.deepest_mm, DepthOf(row));
    data.deepest_mm = std::max(data.deepest_mm, DepthOf(row));
    if (touched.insert(row.frame).second) data.in_contact_s += duration_s[row.frame];
  }
  data.frames_in_contact = static_cast<std::int64_t>(touched.size());
}

std::map<double, SpacingLevel> LevelsOf(const ReportData& data, core::SpacingIndex spacing) {
  const std::map<core::FrameIndex, double> depth_by_frame = DepthByFrame(data, spacing);
  std::map<double, SpacingLevel> levels;
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    SpacingLevel& level = levels[data.frames[i].spacing_mm[spacing]];
    level.spacing_mm = data.frames[i].spacing_mm[spacing];
    level.held_s += DurationOf(data, i);
    ++level.frames;
    const auto depth = depth_by_frame.find(data.frames[i].frame);
    if (depth == depth_by_frame.end()) continue;
    ++level.frames_in_contact;
    level.deepest_mm = std::max(level.deepest_mm, depth->second);
  }
  for (const core::ContactEpisode& episode : data.episodes) {
    if (!IsBoundedBy(data, episode.part, spacing)) continue;
    const auto level = levels.find(episode.spacing_at_peak_mm.at(spacing));
    if (level != levels.end()) ++level->second.touches;
  }
  return levels;
}

SpacingStudy StudyOf(const ReportData& data, core::SpacingIndex spacing) {
  SpacingStudy study;
  study.spacing = spacing;
  for (const FrameSummary& frame : data.frames) {
    const double spacing_mm = frame.spacing_mm[spacing];
    if (study.steps.empty() || study.steps.back().spacing_mm != spacing_mm)
      study.steps.push_back({frame.time_s, spacing_mm});
  }
  for (const auto& [spacing_mm, level] : LevelsOf(data, spacing)) {
    study.levels.push_back(level);
    if (level.frames_in_contact > 0) {
      study.largest_touched_mm = spacing_mm;
      study.smallest_free_mm.reset();
    } else if (!study.smallest_free_mm && level.held_s >= kTriedFor_s) {
      study.smallest_free_mm = spacing_mm;
    }
  }
  return study;
}

std::optional<core::SpacingIndex> SpacingToJudge(const std::vector<SpacingStudy>& studies) {
  if (studies.empty()) return std::nullopt;
  const auto moved = std::ranges::find_if(studies, [](const SpacingStudy& s) { return s.levels.size() > 1; });
  return moved != studies.end() ? moved->spacing : studies.front().spacing;
}

}  // namespace

bool IsBoundedBy(const ReportData& data, core::PartIndex part, core::SpacingIndex spacing) {
  const core::Spacing& gap = data.header.layout.spacings[spacing];
  const core::Layout& layout = data.header.layout;
  return std::ranges::any_of(std::array{&gap.moving, &gap.reference}, [&](const std::string* name) {
    return std::ranges::count(layout.PartsNamed(*name), part) > 0;
  });
}

ReportData CollectReportData(const SessionReader& session) {
  ReportData data;
  data.session_name = session.path().filename().string();
  data.header = session.header();
  data.status = session.status();
  data.has_outcome = session.has_outcome();
  data.ended_at_utc = session.ended_at_utc();
  data.frames = session.frames();
  data.events = session.events();
  data.episodes = session.episodes();
  data.near_misses = session.near_misses();
  data.contacts = session.contacts();
  data.stamps = session.stamp_rows();
  MeasureTime(data);
  SumUpParts(session, data);
  for (core::SpacingIndex i = 0; i < data.header.layout.spacings.size(); ++i) {
    data.spacings.push_back(StudyOf(data, i));
  }
  data.judged_spacing = SpacingToJudge(data.spacings);
  return data;
}

}  // namespace elbowroom::sessions
