#include "app/control/replay/finding_matches.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace elbowroom::control {
namespace {

// A distance on the part that counts as much as a second that two findings don't share.
constexpr double kPlacePerSecondMm = 100.0;

// A touch or near miss of the replay.
struct Candidate {
  core::FindingKind kind = core::FindingKind::kTouch;
  std::string part;
  double begin_s = 0.0;
  double end_s = 0.0;
  std::optional<Eigen::Vector3d> place_in_part_mm;
  core::FindingId* id = nullptr;
};

std::vector<Candidate> CandidatesOf(const core::Layout& layout, core::SessionOutcome* outcome) {
  std::vector<Candidate> candidates;
  for (core::ContactEpisode& episode : outcome->episodes)
    candidates.push_back({core::FindingKind::kTouch, layout.parts[episode.part].name, episode.begin_time_s,
                          episode.end_time_s, episode.peak_position_in_part_mm, &episode.finding_id});
  for (core::NearMiss& miss : outcome->near_misses)
    candidates.push_back({core::FindingKind::kNearMiss, layout.parts[miss.part].name, miss.begin_time_s,
                          miss.end_time_s, miss.place_in_part_mm, &miss.finding_id});
  return candidates;
}

double Disagreement(const core::Finding& finding, const Candidate& candidate) {
  const double unshared_s =
      std::abs(finding.begin_s - candidate.begin_s) + std::abs(finding.end_s - candidate.end_s);
  if (!finding.place_in_part_mm || !candidate.place_in_part_mm) return unshared_s;
  return unshared_s + (*finding.place_in_part_mm - *candidate.place_in_part_mm).norm() / kPlacePerSecondMm;
}

bool MayBeSame(const core::Finding& finding, const Candidate& candidate) {
  return finding.part == candidate.part && finding.begin_s <= candidate.end_s &&
         candidate.begin_s <= finding.end_s;
}

std::set<core::FindingId> IdsOf(const core::SessionOutcome& outcome) {
  std::set<core::FindingId> ids;
  for (const core::ContactEpisode& episode : outcome.episodes) ids.insert(episode.finding_id);
  for (const core::NearMiss& miss : outcome.near_misses) ids.insert(miss.finding_id);
  return ids;
}

bool WasChecked(const core::Finding& finding, const core::Layout& layout, const CheckedRange& checked) {
  return layout.FindPart(finding.part) && checked.begin_s <= finding.begin_s &&
         finding.end_s <= checked.end_s;
}

bool IsSettledWhenGone(core::ReviewStatus status) {
  switch (status) {
    case core::ReviewStatus::kNew:
    case core::ReviewStatus::kActive:
    case core::ReviewStatus::kReviewed:
      return false;
    case core::ReviewStatus::kApproved:
    case core::ReviewStatus::kResolved:
      return true;
  }
  return true;
}

}  // namespace

void MatchFindings(std::span<const core::Finding> origin, const core::Layout& layout,
                   core::SessionOutcome* outcome) {
  const std::vector<Candidate> candidates = CandidatesOf(layout, outcome);
  using Pair = std::tuple<bool, double, std::size_t, std::size_t>;  // other kind, disagreement, which two
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < origin.size(); ++i)
    for (std::size_t k = 0; k < candidates.size(); ++k)
      if (MayBeSame(origin[i], candidates[k]))
        pairs.emplace_back(origin[i].kind != candidates[k].kind, Disagreement(origin[i], candidates[k]), i,
                           k);
  std::ranges::sort(pairs);
  std::set<std::size_t> matched;
  for (const auto& [is_other_kind, disagreement, i, k] : pairs) {
    if (!candidates[k].id->empty() || matched.contains(i)) continue;
    *candidates[k].id = origin[i].id;
    matched.insert(i);
  }
}

sessions::SessionClosing TakeOverReview(std::span<const core::Finding> origin, const core::Layout& layout,
                                        const CheckedRange& checked, const core::SessionOutcome& outcome,
                                        const std::string& by, const std::string& at_utc) {
  const std::set<core::FindingId> here = IdsOf(outcome);
  sessions::SessionClosing closing;
  for (core::Finding finding : origin) {
    for (const core::ReviewRemark& remark : finding.remarks) closing.remarks.emplace_back(finding.id, remark);
    const core::ReviewStatus status = finding.status();
    if (here.contains(finding.id)) {
      if (status == core::ReviewStatus::kResolved)
        closing.remarks.emplace_back(finding.id, core::ReviewRemark{at_utc, by, core::ReviewStatus::kActive,
                                                                    "It was resolved, and was found again."});
      continue;
    }
    const bool is_gone = WasChecked(finding, layout, checked);
    finding.presence = is_gone ? core::FindingPresence::kGone : core::FindingPresence::kNotChecked;
    finding.number = 0;
    if (is_gone && !IsSettledWhenGone(status))
      closing.remarks.emplace_back(
          finding.id, core::ReviewRemark{at_utc, by, core::ReviewStatus::kResolved,
                                         "Its part and time were judged again, and nothing was found."});
    finding.remarks.clear();
    closing.absent.push_back(std::move(finding));
  }
  return closing;
}

}  // namespace elbowroom::control
