// A view as the shaders take it.
#pragma once

#include <Eigen/Core>

#include "core/rigid_transform.h"
#include "recon/appearance/scene_view.h"

namespace elbowroom::recon::gl {

// Clip space is arranged so that OpenGL's row 0, its lowest, is the picture's top row: what is read back
// needs no turning over. Windings therefore appear reversed.
struct ViewMatrices {
  SceneView view;
  Eigen::Matrix4f clip_from_cam;
  Eigen::Matrix4f cam_from_world;
  Eigen::Vector3f up_in_cam;  // world z
};

[[nodiscard]] ViewMatrices MatricesOf(const SceneView& view);
[[nodiscard]] Eigen::Matrix4f ToMatrix4f(const core::RigidTransform& b_from_a);

// Depth along the camera's z axis of a value in [0, 1) of the depth buffer.
[[nodiscard]] float DepthMmOf(float depth_buffer_value, const SceneView& view);

}  // namespace elbowroom::recon::gl
