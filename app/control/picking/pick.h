// Which point of which part lies under the pointer.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/bvh.h"
#include "core/ids.h"
#include "core/rigid_transform.h"
#include "recon/appearance/scene_view.h"

namespace elbowroom::control {

struct PickRay {
  Eigen::Vector3d origin_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_in_world = Eigen::Vector3d::UnitX();  // of unit length
};

// From the eye through a position in the picture, in pixels whose centres are at integers.
[[nodiscard]] PickRay RayThrough(const recon::SceneView& view, const Eigen::Vector2d& pixel);

struct PickablePart {
  std::shared_ptr<const core::TriangleTree> tree;  // null: it can't be picked
  core::RigidTransform world_from_part;
};

struct Pick {
  core::PartIndex part = 0;
  std::uint32_t triangle = 0;  // of the part's mesh
  double distance_mm = 0.0;    // from the ray's origin
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
  // Of the triangle, to its outer side, so that it points along the ray where a surface is seen from inside.
  Eigen::Vector3d normal_in_world = Eigen::Vector3d::UnitZ();
};

// The first triangle that the ray meets (core::FirstMet); nothing if it meets none. `from_mm`: what is nearer
// than this along the ray is not seen (the view's near plane, or a cut). Of two that are equally far, the
// earlier part, then the earlier triangle. Exact but for double's rounding (pick_test holds it against all
// triangles). Thread: any.
[[nodiscard]] std::optional<Pick> PickPart(std::span<const PickablePart> parts, const PickRay& ray,
                                           double from_mm = 0.0);

}  // namespace elbowroom::control
