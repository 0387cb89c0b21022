#include "core/layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/layout_fault.h"
#include "core/pairs_of_rule.h"
#include "core/spelling.h"

namespace elbowroom::core {
namespace {

// How far a mesh reaches along a world axis from its own origin.
struct Extent {
  double lower_mm = std::numeric_limits<double>::infinity();
  double upper_mm = -std::numeric_limits<double>::infinity();
};
Extent ExtentAlong(const Part& part, const RigidTransform& world_from_part, Axis axis) {
  const auto row = world_from_part.rotation.row(static_cast<Eigen::Index>(axis));
  Extent extent;
  for (const Eigen::Vector3d& vertex : part.mesh->vertices_mm) {
    const double reach_mm = row.dot(vertex);
    extent.lower_mm = std::min(extent.lower_mm, reach_mm);
    extent.upper_mm = std::max(extent.upper_mm, reach_mm);
  }
  return extent;
}

}  // namespace

std::optional<Axis> ParseAxis(std::string_view text) {
  if (text == "x") return Axis::kX;
  if (text == "y") return Axis::kY;
  if (text == "z") return Axis::kZ;
  return std::nullopt;
}

std::string_view ToString(Axis axis) {
  constexpr std::string_view kNames[] = {"x", "y", "z"};
  return kNames[static_cast<std::size_t>(axis)];
}

void Layout::Validate() const {
  if (const auto fault = FindLayoutFault(*this)) throw Error(ErrorKind::kRange, fault->message);
}

std::optional<PartIndex> Layout::FindPart(std::string_view name) const {
  for (PartIndex i = 0; i < parts.size(); ++i) {
    if (parts[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<GroupIndex> Layout::FindGroup(std::string_view name) const {
  for (GroupIndex i = 0; i < groups.size(); ++i) {
    if (groups[i].name == name) return i;
  }
  return std::nullopt;
}

std::vector<PartIndex> Layout::PartsNamed(std::string_view name) const {
  if (const auto part = FindPart(name)) return {*part};
  std::vector<PartIndex> result;
  const auto group = FindGroup(name);
  if (!group) return result;
  for (const std::string& member : groups[*group].parts) {
    if (const auto part = FindPart(member)) result.push_back(*part);
  }
  return result;
}

bool Layout::SharePart(std::string_view a, std::string_view b) const {
  const std::vector<PartIndex> of_a = PartsNamed(a), of_b = PartsNamed(b);
  return std::find_first_of(of_a.begin(), of_a.end(), of_b.begin(), of_b.end()) != of_a.end();
}

std::optional<SpacingIndex> Layout::FindSpacing(std::string_view name) const {
  for (SpacingIndex i = 0; i < spacings.size(); ++i) {
    if (spacings[i].name == name) return i;
  }
  return std::nullopt;
}

SpacingIndex RequireSpacing(const Layout& layout, const std::string& name, std::string_view option) {
  if (const auto index = layout.FindSpacing(name)) return *index;
  std::vector<std::string_view> known;
  for (const Spacing& spacing : layout.spacings) known.emplace_back(spacing.name);
  const std::string there_is = known.empty() ? std::string("the layout has no [[spacing]]")
                                             : fmt::format("there is '{}'", fmt::join(known, "', '"));
  throw Error(ErrorKind::kRange, fmt::format("{}: no spacing is named '{}'; {}", option, name,
                                             SpellingAdvice(name, known, there_is)));
}

std::vector<double> Layout::InitialSpacings() const {
  std::vector<double> result;
  for (const Spacing& spacing : spacings) result.push_back(spacing.initial_mm);
  return result;
}

// Rounding keeps order: the largest of rounded sums is the rounded sum with the largest.
SpacingPoses::SpacingPoses(const Layout& layout) : spacing_count_(layout.spacings.size()) {
  for (const Part& part : layout.parts) world_from_parts_.push_back(part.world_from_part);
  for (const SpacingIndex i : OrderOfPlacement(layout)) {
    const Spacing& spacing = layout.spacings[i];
    const auto extent = [&](PartIndex part) {
      return ExtentAlong(layout.parts[part], world_from_parts_[part], spacing.axis);
    };
    Placement placement{i, static_cast<Eigen::Index>(spacing.axis), {}, {}};
    for (const PartIndex part : layout.PartsNamed(spacing.reference))
      placement.tops.push_back({part, extent(part).upper_mm});
    for (const PartIndex part : layout.PartsNamed(spacing.moving))
      placement.bottoms.push_back({part, extent(part).lower_mm});
    placements_.push_back(std::move(placement));
  }
}

std::vector<RigidTransform> SpacingPoses::At(std::span<const double> spacing_mm) const {
  Require(spacing_mm.size() == spacing_count_, "one value a spacing");
  std::vector<RigidTransform> world_from_parts = world_from_parts_;
  for (const Placement& placement : placements_) {
    const auto position_mm = [&](PartIndex part) -> double& {
      return world_from_parts[part].translation_mm[placement.axis];
    };
    double top_mm = Extent().upper_mm, bottom_mm = Extent().lower_mm;
    for (const Reach& reach : placement.tops) top_mm = std::max(top_mm, reach.mm + position_mm(reach.part));
    for (const Reach& reach : placement.bottoms)
      bottom_mm = std::min(bottom_mm, reach.mm + position_mm(reach.part));
    const double shift_mm = top_mm + spacing_mm[placement.spacing] - bottom_mm;
    for (const Reach& reach : placement.bottoms) position_mm(reach.part) += shift_mm;
  }
  return world_from_parts;
}

std::vector<RigidTransform> PosesAt(const Layout& layout, std::span<const double> spacing_mm) {
  return SpacingPoses(layout).At(spacing_mm);
}

double GapMm(const Layout& layout, const Spacing& spacing, std::span<const RigidTransform> world_from_parts) {
  Require(world_from_parts.size() == layout.parts.size(), "one pose a part");
  const auto extent = [&](PartIndex part) {
    return ExtentAlong(layout.parts[part], world_from_parts[part], spacing.axis);
  };
  const auto position_mm = [&](PartIndex part) {
    return world_from_parts[part].translation_mm[static_cast<Eigen::Index>(spacing.axis)];
  };
  double top_mm = Extent().upper_mm, bottom_mm = Extent().lower_mm;
  for (const PartIndex part : layout.PartsNamed(spacing.reference))
    top_mm = std::max(top_mm, extent(part).upper_mm + position_mm(part));
  for (const PartIndex part : layout.PartsNamed(spacing.moving))
    bottom_mm = std::min(bottom_mm, extent(part).lower_mm + position_mm(part));
  return bottom_mm - top_mm;
}

std::vector<SpacingIndex> OrderOfPlacement(const Layout& layout) {
  std::vector<SpacingIndex> order;
  std::set<SpacingIndex> left;
  for (SpacingIndex i = 0; i < layout.spacings.size(); ++i) left.insert(i);
  for (bool progressed = true; progressed && !left.empty();) {
    progressed = false;
    for (auto it = left.begin(); it != left.end();) {
      const Spacing& spacing = layout.spacings[*it];
      const bool waits = std::any_of(left.begin(), left.end(), [&](SpacingIndex other) {
        return other != *it && layout.SharePart(layout.spacings[other].moving, spacing.reference);
      });
      if (waits) {
        ++it;
        continue;
      }
      order.push_back(*it);
      it = left.erase(it);
      progressed = true;
    }
  }
  return order;
}

PairsOfRule PairsOf(const Layout& layout, const PairRule& rule) {
  PairsOfRule result;
  result.parts_named = (layout.FindPart(rule.a) ? 1 : 0) + (layout.FindPart(rule.b) ? 1 : 0);
  for (const PartIndex a : layout.PartsNamed(rule.a)) {
    for (const PartIndex b : layout.PartsNamed(rule.b))
      if (a != b || result.parts_named == 2) result.pairs.insert(std::minmax(a, b));
  }
  return result;
}

Layout WithPairsOfParts(Layout layout) {
  using Pair = std::pair<PartIndex, PartIndex>;
  std::map<Pair, int> most_parts_named;
  std::vector<std::tuple<Pair, int, PairRule>> rules;
  for (const PairRule& rule : layout.pair_rules) {
    const auto [pairs, parts_named] = PairsOf(layout, rule);
    for (const Pair& pair : pairs) {
      most_parts_named[pair] = std::max(most_parts_named[pair], parts_named);
      PairRule of_parts = rule;
      if (parts_named < 2) {
        of_parts.a = layout.parts[pair.first].name;
        of_parts.b = layout.parts[pair.second].name;
      }
      rules.emplace_back(pair, parts_named, std::move(of_parts));
    }
  }
  layout.pair_rules.clear();
  for (auto& [pair, parts_named, rule] : rules)
    if (parts_named == most_parts_named[pair]) layout.pair_rules.push_back(std::move(rule));
  return layout;
}

std::vector<RigidTransform> WithMotions(std::span<const RigidTransform> world_from_rests,
                                        std::span<const RigidTransform> rest_from_parts) {
  Require(rest_from_parts.empty() || rest_from_parts.size() == world_from_rests.size(),
          "one motion a part, or none");
  std::vector<RigidTransform> world_from_parts(world_from_rests.begin(), world_from_rests.end());
  for (std::size_t i = 0; i < rest_from_parts.size(); ++i)
    world_from_parts[i] = world_from_rests[i] * rest_from_parts[i];
  return world_from_parts;
}

}  // namespace elbowroom::core
