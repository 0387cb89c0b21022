#include "app/control/layout_editing/pair_of_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/layout_fault.h"

namespace elbowroom::control {
namespace {

constexpr double kUsualClearanceMm = 5.0;
constexpr double kRoomMm = 100.0;  // that the gap may grow by, at least
constexpr double kRoomStepMm = 50.0, kOverlapStepMm = 10.0;
constexpr double kGapStepMm = 0.001;  // nobody sets a gap more finely

std::string FreeSpacingName(const core::Layout& layout, const std::string& wanted) {
  std::string name = wanted;
  for (int i = 2; layout.FindSpacing(name); ++i) name = fmt::format("{}_{}", wanted, i);
  return name;
}

bool CanHave(core::Layout layout, const core::Spacing& spacing) {
  layout.spacings.push_back(spacing);
  return !core::FindLayoutFault(layout);
}

}  // namespace

core::Spacing ProposeSpacing(const core::Layout& layout,
                             std::span<const core::RigidTransform> world_from_parts, const std::string& first,
                             const std::string& second) {
  core::Require(first != second && layout.FindPart(first) && layout.FindPart(second), "two parts");
  std::vector<core::Spacing> choices;  // the best first
  for (const core::Axis axis : {core::Axis::kZ, core::Axis::kX, core::Axis::kY}) {
    for (const auto& [moving, reference] : {std::pair(second, first), std::pair(first, second)}) {
      core::Spacing spacing{FreeSpacingName(layout, fmt::format("{}_to_{}", reference, moving)),
                            moving,
                            reference,
                            axis,
                            0.0,
                            0.0,
                            0.0};
      const double gap_mm =
          std::round(core::GapMm(layout, spacing, world_from_parts) / kGapStepMm) * kGapStepMm;
      spacing.initial_mm = gap_mm;
      spacing.min_mm = std::min(0.0, std::floor(gap_mm / kOverlapStepMm) * kOverlapStepMm);
      spacing.max_mm = std::ceil((gap_mm + kRoomMm) / kRoomStepMm) * kRoomStepMm;
      choices.push_back(std::move(spacing));
    }
  }
  std::ranges::stable_sort(choices, std::greater<>(), &core::Spacing::initial_mm);
  const auto possible =
      std::ranges::find_if(choices, [&](const core::Spacing& spacing) { return CanHave(layout, spacing); });
  return possible == choices.end() ? choices.front() : *possible;
}

core::PairRule ProposePairRule(const core::Layout& layout, const std::string& first,
                               const std::string& second) {
  const auto is_theirs = [&](const core::PairRule& rule) {
    return std::minmax(rule.a, rule.b) == std::minmax(first, second);
  };
  const auto found = std::ranges::find_if(layout.pair_rules, is_theirs);
  if (found != layout.pair_rules.end()) return *found;
  core::PairRule rule;
  rule.a = first;
  rule.b = second;
  rule.required_clearance_mm = kUsualClearanceMm;
  return rule;
}

}  // namespace elbowroom::control
