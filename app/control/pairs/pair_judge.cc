#include "app/control/pairs/pair_judge.h"

#include <utility>

namespace elbowroom::control {

PairJudge::PairJudge(core::Layout layout, std::vector<review::PairDemand> pairs)
    : layout_(std::move(layout)), pairs_(std::move(pairs)) {}

SharedPairVerdicts PairJudge::Judge(PairSetting setting, const std::stop_token& stop) {
  if (!checker_) checker_.emplace(layout_, pairs_);
  review::ClashReport report = checker_->Check(core::PosesAt(layout_, setting.spacing_mm), {}, stop);
  return std::make_shared<const PairVerdicts>(
      PairVerdicts{std::move(setting), std::move(report.pairs), report.count});
}

}  // namespace elbowroom::control
