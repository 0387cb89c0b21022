#include "app/control/pairs/ruled_pairs.h"

#include <algorithm>
#include <set>
#include <utility>

namespace elbowroom::control {

std::vector<review::PairDemand> RuledPairsOf(const core::Layout& layout_with_groups) {
  if (layout_with_groups.pair_rules.empty()) return {};
  const core::Layout layout = core::WithPairsOfParts(layout_with_groups);
  std::set<std::pair<core::PartIndex, core::PartIndex>> ruled;
  for (const core::PairRule& rule : layout.pair_rules) {
    const auto a = layout.FindPart(rule.a), b = layout.FindPart(rule.b);
    if (a && b) ruled.insert(std::minmax(*a, *b));
  }
  std::vector<review::PairDemand> pairs = review::PairsOf(layout).pairs;
  std::erase_if(pairs, [&](const review::PairDemand& pair) { return !ruled.contains({pair.a, pair.b}); });
  return pairs;
}

std::vector<std::size_t> PairsMovedBy(const core::Layout& layout, core::SpacingIndex spacing,
                                      const std::vector<review::PairDemand>& pairs) {
  if (pairs.empty()) return {};
  constexpr double kStepMm = 1.0, kMovesMm = 1e-3;
  std::vector<double> spacing_mm = layout.InitialSpacings();
  const std::vector<core::RigidTransform> before = core::PosesAt(layout, spacing_mm);
  spacing_mm.at(spacing) += kStepMm;
  const std::vector<core::RigidTransform> after = core::PosesAt(layout, spacing_mm);
  const auto way_mm = [&](core::PartIndex part) -> Eigen::Vector3d {
    return after[part].translation_mm - before[part].translation_mm;
  };
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if ((way_mm(pairs[i].a) - way_mm(pairs[i].b)).norm() > kMovesMm) moved.push_back(i);
  return moved;
}

}  // namespace elbowroom::control
