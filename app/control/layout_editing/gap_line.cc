#include "app/control/layout_editing/gap_line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

namespace elbowroom::control {
namespace {

Eigen::AlignedBox3d BoxOf(const core::Layout& layout, const std::string& part_or_group,
                          std::span<const core::RigidTransform> world_from_parts) {
  Eigen::AlignedBox3d box;
  for (const core::PartIndex i : layout.PartsNamed(part_or_group))
    box.extend(core::BoundsOf(*layout.parts[i].mesh, world_from_parts[i]));
  return box;
}

}  // namespace

std::array<Eigen::Vector3d, 2> GapLine(const core::Layout& layout, const core::Spacing& gap,
                                       std::span<const core::RigidTransform> world_from_parts) {
  const Eigen::AlignedBox3d below = BoxOf(layout, gap.reference, world_from_parts);
  const Eigen::AlignedBox3d above = BoxOf(layout, gap.moving, world_from_parts);
  const auto axis = static_cast<Eigen::Index>(gap.axis);
  Eigen::Vector3d from = above.center();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double low = std::max(below.min()[i], above.min()[i]);
    const double high = std::min(below.max()[i], above.max()[i]);
    if (low <= high) from[i] = 0.5 * (low + high);
  }
  Eigen::Vector3d to = from;
  from[axis] = below.max()[axis];
  to[axis] = above.min()[axis];
  return {from, to};
}

}  // namespace elbowroom::control
