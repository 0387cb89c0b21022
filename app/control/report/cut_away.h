// A plane that takes away what hides a place.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "app/control/frame_result.h"
#include "sessions/bcf/bcf_topic.h"

namespace elbowroom::control {

// Between the cut and the place, mm, so that the surface that was touched stays.
inline constexpr double kCutBeforeMm = 25.0;

// At right angles to the line from the eye to the place, that far before it. Nothing: no part crosses the
// line before there, or the eye is nearer.
[[nodiscard]] std::optional<sessions::TopicCut> CutBefore(const FrameResult& result,
                                                          const Eigen::Vector3d& eye_in_world_mm,
                                                          const Eigen::Vector3d& place_in_world_mm);

}  // namespace elbowroom::control
