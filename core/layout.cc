#include "core/layout.h"

#include <fmt/format.h>

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

// Where a mesh ends along a world axis when it stands at world_from_part.
struct Extent {
  double lower_mm;
  double upper_mm;
};
Extent ExtentAlong(const Part& part, const RigidTransform& world_from_part, Axis axis) {
  const auto row = static_cast<Eigen::Index>(axis);
  Extent extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector3d& vertex : part.mesh->vertices_mm) {
    const double position_mm =
        world_from_part.rotation.row(row).dot(vertex) + world_from_part.translation_mm[row];
    extent.lower_mm = std::min(extent.lower_mm, position_mm);
    extent.upper_mm = std::max(extent.upper_mm, position_mm);
  }
  return extent;
}

// Where the part, or all parts of the group together, end along the axis.
Extent ExtentAlong(const Layout& layout, std::string_view part_or_group,
                   std::span<const RigidTransform> world_from_parts, Axis axis) {
  Extent all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const PartIndex i : layout.PartsNamed(part_or_group)) {
    const Extent extent = ExtentAlong(layout.parts[i], world_from_parts[i], axis);
    all.lower_mm = std::min(all.lower_mm, extent.lower_mm);
    all.upper_mm = std::max(all.upper_mm, extent.upper_mm);
  }
  return all;
}

// The two ends of a gap.
struct Facing {
  double below_mm;
  double above_mm;
};
Facing FacingExtents(const Layout& layout, const Spacing& spacing,
                     std::span<const RigidTransform> world_from_parts) {
  return {ExtentAlong(layout, spacing.reference, world_from_parts, spacing.axis).upper_mm,
          ExtentAlong(layout, spacing.moving, world_from_parts, spacing.axis).lower_mm};
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
  throw Error(ErrorKind::kRange, fmt::format("{}: no spacing is named '{}'; {}", option, name,
                                             SpellingAdvice(name, known, "use the name of a [[spacing]]")));
}

std::vector<double> Layout::InitialSpacings() const {
  std::vector<double> result;
  for (const Spacing& spacing : spacings) result.push_back(spacing.initial_mm);
  return result;
}

std::vector<RigidTransform> PosesAt(const Layout& layout, std::span<const double> spacing_mm) {
  Require(spacing_mm.size() == layout.spacings.size(), "one value a spacing");
  std::vector<RigidTransform> world_from_parts;
  for (const Part& part : layout.parts) world_from_parts.push_back(part.world_from_part);
  for (const SpacingIndex i : OrderOfPlacement(layout)) {
    const Spacing& spacing = layout.spacings[i];
    const Facing facing = FacingExtents(layout, spacing, world_from_parts);
    const double shift_mm = facing.below_mm + spacing_mm[i] - facing.above_mm;
    for (const PartIndex moving : layout.PartsNamed(spacing.moving))
      world_from_parts[moving].translation_mm[static_cast<Eigen::Index>(spacing.axis)] += shift_mm;
  }
  return world_from_parts;
}

double GapMm(const Layout& layout, const Spacing& spacing, std::span<const RigidTransform> world_from_parts) {
  Require(world_from_parts.size() == layout.parts.size(), "one pose a part");
  const Facing facing = FacingExtents(layout, spacing, world_from_parts);
  return facing.above_mm - facing.below_mm;
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
