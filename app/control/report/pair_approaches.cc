#include "app/control/report/pair_approaches.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "review/clash.h"

namespace elbowroom::control {
namespace {

using Spacings = std::vector<double>;

struct Setting {
  double first_s = 0.0;
  std::int64_t frames = 0;
};

std::map<Spacings, Setting> SettingsOf(std::span<const sessions::FrameSummary> frames) {
  std::map<Spacings, Setting> settings;
  for (const sessions::FrameSummary& frame : frames) {
    const auto [entry, is_new] = settings.try_emplace(frame.spacing_mm, Setting{frame.time_s});
    ++entry->second.frames;
  }
  return settings;
}

// Those to judge.
std::set<Spacings> Chosen(const std::map<Spacings, Setting>& settings, std::size_t spacings) {
  std::vector<std::pair<std::int64_t, Spacings>> by_time;
  for (const auto& [spacing_mm, setting] : settings) by_time.emplace_back(-setting.frames, spacing_mm);
  std::ranges::stable_sort(by_time, {}, &std::pair<std::int64_t, Spacings>::first);
  std::set<Spacings> chosen;
  for (std::size_t i = 0; i < std::min(by_time.size(), kMostSettings); ++i) chosen.insert(by_time[i].second);
  for (std::size_t i = 0; i < spacings; ++i) {
    const auto [least, most] =
        std::ranges::minmax_element(settings, {}, [&](const auto& entry) { return entry.first[i]; });
    chosen.insert({least->first, most->first});
  }
  return chosen;
}

// The rules' pairs; without a rule nothing is asked of two parts.
std::vector<review::PairDemand> RuledPairs(const core::Layout& layout) {
  std::set<std::pair<core::PartIndex, core::PartIndex>> ruled;
  for (const core::PairRule& rule : layout.pair_rules) {
    const auto a = layout.FindPart(rule.a), b = layout.FindPart(rule.b);
    if (a && b) ruled.insert(std::minmax(*a, *b));
  }
  std::vector<review::PairDemand> pairs = review::PairsOf(layout).pairs;
  std::erase_if(pairs, [&](const review::PairDemand& pair) { return !ruled.contains({pair.a, pair.b}); });
  return pairs;
}

bool IsBroken(const review::PairClash& clash) {
  if (clash.verdict == core::Verdict::kClear) return false;
  return clash.verdict != core::Verdict::kContact || !clash.demand.authorised_contact;
}

double GapMm(const review::PairClash& clash) {
  return clash.gap ? clash.gap->distance_mm : clash.at_least_mm;
}

sessions::PairApproach ApproachOf(const review::PairClash& clash, const Spacings& spacing_mm,
                                  double first_s) {
  sessions::PairApproach approach{clash.demand.a,
                                  clash.demand.b,
                                  clash.demand.required_mm,
                                  clash.demand.authorised_contact,
                                  clash.verdict,
                                  std::nullopt,
                                  clash.at_least_mm,
                                  spacing_mm,
                                  first_s,
                                  0.0};
  if (clash.gap) approach.gap_mm = clash.gap->distance_mm;
  return approach;
}

}  // namespace

sessions::PairApproaches PairApproachesOf(const core::Layout& layout_with_groups,
                                          std::span<const sessions::FrameSummary> frames,
                                          double frame_period_s, const std::stop_token& stop) {
  const core::Layout layout = core::WithPairsOfParts(layout_with_groups);
  const std::vector<review::PairDemand> pairs = RuledPairs(layout);
  sessions::PairApproaches approaches;
  if (pairs.empty() || frames.empty()) return approaches;
  const std::map<Spacings, Setting> settings = SettingsOf(frames);
  review::ClashChecker checker(layout, pairs);
  std::vector<double> broken_s(pairs.size(), 0.0);
  for (const Spacings& spacing_mm : Chosen(settings, layout.spacings.size())) {
    const Setting& setting = settings.at(spacing_mm);
    const review::ClashReport report = checker.Check(core::PosesAt(layout, spacing_mm), {}, stop);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const review::PairClash& clash = report.pairs[i];
      if (IsBroken(clash)) broken_s[i] += static_cast<double>(setting.frames) * frame_period_s;
      sessions::PairApproach approach = ApproachOf(clash, spacing_mm, setting.first_s);
      if (approaches.pairs.size() == i) {
        approaches.pairs.push_back(std::move(approach));
      } else if (GapMm(clash) < approaches.pairs[i].gap_mm.value_or(approaches.pairs[i].at_least_mm)) {
        approaches.pairs[i] = std::move(approach);
      }
    }
    ++approaches.judged;
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) approaches.pairs[i].broken_s = broken_s[i];
  approaches.settings = settings.size();
  return approaches;
}

}  // namespace elbowroom::control
