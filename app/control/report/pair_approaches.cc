#include "app/control/report/pair_approaches.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "app/control/pairs/ruled_pairs.h"
#include "review/clash.h"

namespace elbowroom::control {
namespace {

using Spacings = std::vector<double>;

// How many frames had each.
std::map<Spacings, std::int64_t> SettingsOf(std::span<const sessions::FrameSummary> frames) {
  std::map<Spacings, std::int64_t> settings;
  for (const sessions::FrameSummary& frame : frames) ++settings[frame.spacing_mm];
  return settings;
}

// Those to judge.
std::set<Spacings> Chosen(const std::map<Spacings, std::int64_t>& settings, std::size_t spacings) {
  std::vector<std::pair<std::int64_t, Spacings>> by_frames;
  for (const auto& [spacing_mm, of_it] : settings) by_frames.emplace_back(-of_it, spacing_mm);
  std::ranges::stable_sort(by_frames, {}, &std::pair<std::int64_t, Spacings>::first);
  std::set<Spacings> chosen;
  for (std::size_t i = 0; i < std::min(by_frames.size(), kMostSettings); ++i)
    chosen.insert(by_frames[i].second);
  for (std::size_t i = 0; i < spacings; ++i) {
    const auto [least, most] =
        std::ranges::minmax_element(settings, {}, [&](const auto& entry) { return entry.first[i]; });
    chosen.insert({least->first, most->first});
  }
  return chosen;
}

sessions::PairDistance DistanceOf(const review::PairClash& clash) {
  sessions::PairDistance distance{clash.verdict, std::nullopt, clash.at_least_mm};
  if (clash.gap) distance.gap_mm = clash.gap->distance_mm;
  return distance;
}

}  // namespace

sessions::PairApproaches PairApproachesOf(const core::Layout& layout_with_groups,
                                          std::span<const sessions::FrameSummary> frames,
                                          const std::stop_token& stop) {
  const core::Layout layout = core::WithPairsOfParts(layout_with_groups);
  const std::vector<review::PairDemand> demands = RuledPairsOf(layout);
  sessions::PairApproaches approaches;
  if (demands.empty() || frames.empty()) return approaches;
  for (const review::PairDemand& demand : demands)
    approaches.pairs.push_back({demand.a, demand.b, demand.required_mm, demand.authorised_contact});
  const std::map<Spacings, std::int64_t> settings = SettingsOf(frames);
  approaches.settings = settings.size();
  review::ClashChecker checker(layout, demands);
  for (const Spacings& spacing_mm : Chosen(settings, layout.spacings.size())) {
    sessions::PairSetting setting{spacing_mm, {}};
    for (const review::PairClash& clash : checker.Check(core::PosesAt(layout, spacing_mm), {}, stop).pairs)
      setting.distances.push_back(DistanceOf(clash));
    approaches.judged.push_back(std::move(setting));
  }
  return approaches;
}

}  // namespace elbowroom::control
