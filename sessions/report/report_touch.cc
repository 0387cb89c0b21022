#include "sessions/report/report_touch.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

#include "sessions/report/report.h"

namespace elbowroom::sessions {
namespace {

ReportTouch RowOf(const core::ContactEpisode& episode) {
  ReportTouch touch;
  touch.id = episode.id;
  touch.finding_id = episode.finding_id;
  touch.part = episode.part;
  touch.frame = episode.peak_frame;
  touch.begin_s = episode.begin_time_s;
  touch.time_s = episode.peak_time_s;
  touch.end_s = episode.end_time_s;
  touch.depth_mm = episode.peak_depth_mm;
  touch.area_mm2 = episode.peak_area_mm2;
  touch.at_in_world_mm = episode.peak_position_in_world_mm;
  touch.spacing_mm = episode.spacing_at_peak_mm;
  touch.tools = episode.tools;
  return touch;
}

ReportTouch RowOf(const core::NearMiss& miss) {
  ReportTouch touch;
  touch.is_near_miss = true;
  touch.id = miss.id;
  touch.finding_id = miss.finding_id;
  touch.part = miss.part;
  touch.frame = miss.closest_frame;
  touch.begin_s = miss.begin_time_s;
  touch.time_s = miss.closest_time_s;
  touch.end_s = miss.end_time_s;
  touch.closest = miss.closest;
  touch.is_sure = miss.verdict == core::Verdict::kNear;
  if (miss.closest.has_witnesses) touch.at_in_world_mm = miss.closest.interval.witness_part_in_world_mm;
  touch.spacing_mm = miss.spacing_at_closest_mm;
  touch.tools = miss.tools;
  return touch;
}

std::map<core::FindingId, std::string> ReviewStatusesOf(const SessionReader& session) {
  std::map<core::FindingId, std::string> statuses;
  for (const core::Finding& finding : session.findings())
    statuses.emplace(finding.id, core::ToString(finding.status()));
  return statuses;
}

bool IsWorse(const ReportTouch& a, const ReportTouch& b) {
  const auto badness = [](const ReportTouch& touch) {
    return std::tuple(touch.is_near_miss, touch.closest ? touch.closest->interval.upper_mm : 0.0,
                      -touch.depth_mm, touch.time_s);
  };
  return badness(a) < badness(b);
}

}  // namespace

std::string NameOf(const ReportTouch& touch) {
  return fmt::format("{} {}", touch.is_near_miss ? "near miss" : "touch", touch.id);
}

TouchList TouchesOf(const SessionReader& session) {
  TouchList list;
  const std::vector<core::ContactEpisode> episodes = session.episodes();
  for (const core::ContactEpisode& episode : episodes) list.touches.push_back(RowOf(episode));
  for (const core::NearMiss& miss : session.near_misses()) list.touches.push_back(RowOf(miss));
  std::ranges::stable_sort(list.touches, IsWorse);
  if (list.touches.size() > kMostTouches) {
    list.left_out = list.touches.size() - kMostTouches;
    list.touches.resize(kMostTouches);
  }
  std::ranges::stable_sort(list.touches, {}, [](const ReportTouch& touch) {
    return std::tuple(touch.part, touch.begin_s, touch.is_near_miss);
  });
  const std::map<core::FindingId, std::string> statuses = ReviewStatusesOf(session);
  for (ReportTouch& touch : list.touches) touch.status = statuses.at(touch.finding_id);
  if (const auto worst = WorstEpisode(episodes)) {
    const auto at = std::ranges::find_if(
        list.touches, [&](const ReportTouch& touch) { return !touch.is_near_miss && touch.id == worst->id; });
    if (at != list.touches.end()) list.worst = static_cast<std::size_t>(at - list.touches.begin());
  }
  return list;
}

}  // namespace elbowroom::sessions
