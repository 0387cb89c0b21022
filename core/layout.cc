#include "core/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/error.h"

namespace elbowroom::core {
namespace {

[[noreturn]] void Fail(const std::string& message) { throw Error(ErrorKind::kRange, message); }

void RequirePart(const Layout& layout, const std::string& part, const std::string& who) {
  if (!layout.FindPart(part))
    Fail(fmt::format("{}: no part is named '{}'; check the spelling of [[part]] names", who, part));
}

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

// Spacings in an order that places every reference before the parts that move against it; fewer than all of
// them if they are circular.
std::vector<SpacingIndex> OrderOfPlacement(const Layout& layout) {
  std::vector<SpacingIndex> order;
  std::set<SpacingIndex> left;
  for (SpacingIndex i = 0; i < layout.spacings.size(); ++i) left.insert(i);
  for (bool progressed = true; progressed && !left.empty();) {
    progressed = false;
    for (auto it = left.begin(); it != left.end();) {
      const std::string& reference = layout.spacings[*it].reference;
      const bool waits = std::any_of(left.begin(), left.end(), [&](SpacingIndex other) {
        return other != *it && layout.spacings[other].moving == reference;
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

void ValidateSpacing(const Layout& layout, const Spacing& spacing) {
  const std::string who = fmt::format("spacing '{}'", spacing.name);
  RequirePart(layout, spacing.moving, who);
  RequirePart(layout, spacing.reference, who);
  if (spacing.moving == spacing.reference) Fail(who + ": a part can't move against itself");
  const bool is_ordered = spacing.min_mm <= spacing.initial_mm && spacing.initial_mm <= spacing.max_mm;
  if (!is_ordered || !std::isfinite(spacing.min_mm) || !std::isfinite(spacing.max_mm)) {
    Fail(fmt::format("{}: min_mm <= initial_mm <= max_mm must hold, not {} <= {} <= {}", who, spacing.min_mm,
                     spacing.initial_mm, spacing.max_mm));
  }
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
  std::set<std::string> names;
  for (const Part& part : parts) {
    if (part.name.empty()) Fail("a [[part]] has no name; give each one a name of its own");
    if (!names.insert(part.name).second)
      Fail(fmt::format("two parts are named '{}'; names must differ", part.name));
    if (!part.mesh) Fail(fmt::format("part '{}' has no mesh", part.name));
    if (const auto broken = part.recovery.BrokenRule())
      Fail(fmt::format("part '{}': recovery: {}", part.name, *broken));
    ValidateGivesWay(part.gives_way, fmt::format("part '{}'", part.name));
  }
  std::set<std::string> spacing_names;
  for (const Spacing& spacing : spacings) {
    if (!spacing_names.insert(spacing.name).second) {
      Fail(fmt::format("two spacings are named '{}'; names must differ", spacing.name));
    }
    ValidateSpacing(*this, spacing);
  }
  std::set<std::string> stream_names;
  for (const Stream& stream : streams) {
    if (!stream_names.insert(stream.name).second)
      Fail(fmt::format("two streams are named '{}'; names must differ", stream.name));
    ValidateStream(stream);
  }
  for (const PairRule& rule : pair_rules) {
    RequirePart(*this, rule.a, "[[pair]]");
    RequirePart(*this, rule.b, "[[pair]]");
  }
  if (OrderOfPlacement(*this).size() != spacings.size()) {
    Fail("the spacings are circular: each part must hang, through its references, on one that doesn't move");
  }
}

std::optional<PartIndex> Layout::FindPart(std::string_view name) const {
  for (PartIndex i = 0; i < parts.size(); ++i) {
    if (parts[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<SpacingIndex> Layout::FindSpacing(std::string_view name) const {
  for (SpacingIndex i = 0; i < spacings.size(); ++i) {
    if (spacings[i].name == name) return i;
  }
  return std::nullopt;
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
    const PartIndex moving = *layout.FindPart(spacing.moving);
    const PartIndex reference = *layout.FindPart(spacing.reference);
    const Extent below = ExtentAlong(layout.parts[reference], world_from_parts[reference], spacing.axis);
    const Extent above = ExtentAlong(layout.parts[moving], world_from_parts[moving], spacing.axis);
    world_from_parts[moving].translation_mm[static_cast<Eigen::Index>(spacing.axis)] +=
        below.upper_mm + spacing_mm[i] - above.lower_mm;
  }
  return world_from_parts;
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
