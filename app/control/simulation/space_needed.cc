#include "app/control/simulation/space_needed.h"

#include <algorithm>

#include "core/error.h"

namespace elbowroom::control {
namespace {

Eigen::AlignedBox3d ExtentOf(const core::Layout& layout, const std::string& name) {
  Eigen::AlignedBox3d extent;
  for (const core::PartIndex part : layout.PartsNamed(name))
    for (const Eigen::Vector3d& vertex : layout.parts[part].mesh->vertices_mm)
      extent.extend(layout.parts[part].world_from_part * vertex);
  return extent;
}

}  // namespace

SpaceNeeded::SpaceNeeded(const core::Layout& layout, const std::string& spacing) {
  const core::Spacing& of = layout.spacings[core::RequireSpacing(layout, spacing)];
  core::Require(of.axis == core::Axis::kZ, "a gap along z");
  const Eigen::AlignedBox3d moving = ExtentOf(layout, of.moving), reference = ExtentOf(layout, of.reference);
  below_mm_ = {Eigen::Vector2d(moving.min().head<2>()), Eigen::Vector2d(moving.max().head<2>())};
  reference_top_mm_ = reference.max().z();
  min_mm_ = of.min_mm;
  max_mm_ = of.max_mm;
}

void SpaceNeeded::Add(std::span<const recon::SyntheticObject> objects) {
  highest_mm_ = std::max(highest_mm_, recon::HighestZMm(objects, below_mm_).value_or(0.0));
}

double SpaceNeeded::gap_mm() const { return std::clamp(highest_mm_ - reference_top_mm_, min_mm_, max_mm_); }

}  // namespace elbowroom::control
