// Corners of virtual parts, as marks in a picture.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/control/frame_result.h"
#include "recon/head_pose/head_camera.h"

namespace elbowroom::control {

struct SceneCorner {
  std::string part;
  Eigen::Vector3d x_in_world = Eigen::Vector3d::Zero();
};

// Ends of the parts' sharp edges where they stand in a frame; streams and what hangs have none.
[[nodiscard]] std::vector<SceneCorner> CornersOf(const FrameResult& result);

// The corner that the camera sees nearest to a place in its picture, of those as near as that to within a
// pixel the one in front; nothing within `most_px`.
[[nodiscard]] std::optional<SceneCorner> CornerAt(const std::vector<SceneCorner>& corners,
                                                  const recon::HeadCamera& camera,
                                                  const core::RigidTransform& world_from_head,
                                                  const Eigen::Vector2d& pixel, double most_px);

}  // namespace elbowroom::control
