// The pairs of a layout's rules, judged where the spacings put them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/ids.h"
#include "core/layout.h"
#include "core/pairs_of_rule.h"
#include "review/clash.h"

namespace elbowroom::control {

// The spacings' values, and the frame from which on they held.
struct PairSetting {
  core::FrameIndex frame = 0;
  double time_s = 0.0;
  std::vector<double> spacing_mm;  // in the layout's order
};

// Of one setting: every pair of RuledPairsOf, in that order, and what was skipped to judge them.
struct PairVerdicts {
  PairSetting setting;
  std::vector<review::PairClash> pairs;
  review::ClashCount count;
};

using SharedPairVerdicts = std::shared_ptr<const PairVerdicts>;

[[nodiscard]] inline bool IsBroken(const review::PairClash& pair) {
  return core::BreaksPairRule(pair.verdict, pair.demand.authorised_contact);
}

// Parts are judged as by `elbowroom clash`, where they stand before any of them gives way. Keeps FCL's models
// and the last answers. Thread: one.
class PairJudge {
 public:
  // `pairs`: of RuledPairsOf(layout). The models are made with the first setting.
  PairJudge(core::Layout layout, std::vector<review::PairDemand> pairs);

  // Throws: core::Error{kCancelled}; the last answers stay.
  [[nodiscard]] SharedPairVerdicts Judge(PairSetting setting, const std::stop_token& stop = {});

  [[nodiscard]] const std::vector<review::PairDemand>& pairs() const { return pairs_; }

 private:
  core::Layout layout_;
  std::vector<review::PairDemand> pairs_;
  std::optional<review::ClashChecker> checker_;
};

}  // namespace elbowroom::control
