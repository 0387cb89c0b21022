// The lamp over a scene: where its light comes from and how far its shadows reach.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "recon/appearance/scene_view.h"

namespace elbowroom::recon::gl {

// What stands within `reach_mm` of the target throws shadows; what stands outside of the lamp's cone around
// that ball is lit and throws none.
struct SceneLamp {
  Eigen::Vector3d position_in_world = {-500.0, -1900.0, 2300.0};
  Eigen::Vector3d target_in_world = {0.0, 0.0, 150.0};
  double reach_mm = 700.0;    // of the ball around the target; less than the lamp's distance
  int part_shadow_px = 1024;  // side of the square picture from the lamp that the parts' shadows come from

  // Throws: PreconditionError: reach not positive or not less than the distance, a side not positive.
  void Validate() const;

  // From the lamp, a square picture that just holds the ball.
  [[nodiscard]] SceneView ShadowView(int side_px) const;

  [[nodiscard]] bool operator==(const SceneLamp&) const = default;
};

// Over the box's front left, seen from where OrbitCamera starts; all of the box throws shadows.
[[nodiscard]] SceneLamp LampOver(const Eigen::AlignedBox3d& box_in_world);

}  // namespace elbowroom::recon::gl
