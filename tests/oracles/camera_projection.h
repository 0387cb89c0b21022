// OpenCV's projection formulas, written out once more in long double: an oracle shares no code with what it
// judges.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera_model.h"
#include "tests/oracles/picture_labels.h"

namespace elbowroom::oracles {

[[nodiscard]] Vector3L InCam(const core::CameraModel& camera, const Vector3L& x_in_world);

// Pixel position (may lie outside the picture); nothing behind the camera plane or outside the lens's domain
// (CameraModel::max_radius(): part of the hull's definition, not of the formulas).
[[nodiscard]] std::optional<Vector2L> Project(const core::CameraModel& camera, const Vector3L& x_in_world);

}  // namespace elbowroom::oracles
