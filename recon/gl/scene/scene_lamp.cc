#include "recon/gl/scene/scene_lamp.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::recon::gl {
namespace {

// In reaches: far enough that shadows are nearly those of the sun, near enough that they spread a little.
constexpr double kLampDistance = 4.0;
// Nothing is nearer to a lamp than this share of the distance to its target.
constexpr double kNearestShare = 0.01;

}  // namespace

void SceneLamp::Validate() const {
  core::Require(reach_mm > 0.0 && reach_mm < (target_in_world - position_in_world).norm(),
                "a lamp stands outside of the ball that it throws shadows in");
  core::Require(part_shadow_px > 0, "a shadow's picture has a positive size");
}

SceneView SceneLamp::ShadowView(int side_px) const {
  const double distance_mm = (target_in_world - position_in_world).norm();
  const double cone_tangent = reach_mm / std::sqrt(distance_mm * distance_mm - reach_mm * reach_mm);
  SceneView view;
  view.cam_from_world = core::CamFromWorldLookingAt(position_in_world, target_in_world);
  view.width_px = view.height_px = side_px;
  view.focal_px = 0.5 * side_px / cone_tangent;
  view.near_mm = std::max(distance_mm - reach_mm, kNearestShare * distance_mm);
  view.far_mm = distance_mm + reach_mm;
  return view;
}

SceneLamp LampOver(const Eigen::AlignedBox3d& box_in_world) {
  core::Require(!box_in_world.isEmpty(), "a lamp stands over something");
  SceneLamp lamp;
  lamp.target_in_world = box_in_world.center();
  lamp.reach_mm = std::max(0.5 * box_in_world.diagonal().norm(), 1.0);
  const Eigen::Vector3d to_lamp = Eigen::Vector3d(-0.32, -0.71, 0.63).normalized();
  lamp.position_in_world = lamp.target_in_world + kLampDistance * lamp.reach_mm * to_lamp;
  return lamp;
}

}  // namespace elbowroom::recon::gl
