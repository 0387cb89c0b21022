#include "app/control/reviewing/listed_findings.h"

#include <algorithm>
#include <utility>

namespace elbowroom::control {
namespace {

void TakeTouch(const ReviewedSession& session, const core::ContactEpisode& touch, ListedFinding* listed) {
  listed->worst_position = session.PositionOf(touch.peak_frame);
  listed->worst_s = touch.peak_time_s;
  listed->depth_mm = touch.peak_depth_mm;
  listed->spacing_mm = touch.spacing_at_peak_mm;
  listed->tools = touch.tools;
}

void TakeNearMiss(const ReviewedSession& session, const core::NearMiss& miss, ListedFinding* listed) {
  listed->worst_position = session.PositionOf(miss.closest_frame);
  listed->worst_s = miss.closest_time_s;
  listed->clearance_mm = miss.closest.interval.upper_mm;
  listed->spacing_mm = miss.spacing_at_closest_mm;
  listed->tools = miss.tools;
}

}  // namespace

std::vector<ListedFinding> ListFindings(const ReviewedSession& session) {
  const core::SessionOutcome& outcome = session.outcome();
  std::vector<ListedFinding> list;
  for (core::Finding& finding : session.findings()) {
    ListedFinding listed;
    listed.part = session.header().layout.FindPart(finding.part);
    listed.worst_s = finding.begin_s;
    const auto touch = std::ranges::find(outcome.episodes, finding.id, &core::ContactEpisode::finding_id);
    const auto miss = std::ranges::find(outcome.near_misses, finding.id, &core::NearMiss::finding_id);
    if (touch != outcome.episodes.end()) {
      TakeTouch(session, *touch, &listed);
    } else if (miss != outcome.near_misses.end()) {
      TakeNearMiss(session, *miss, &listed);
    }
    listed.finding = std::move(finding);
    list.push_back(std::move(listed));
  }
  return list;
}

}  // namespace elbowroom::control
