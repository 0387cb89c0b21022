// Rigs that are not what their calibration says, and pictures on the paper's planes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/rig.h"
#include "recon/hull/ray.h"
#include "recon/images/depth_map.h"
#include "recon/synthetic/solids.h"
#include "tests/oracles/analytic_hull.h"

namespace elbowroom::accuracy {

struct Disturbance {
  double rotation_deg = 0.0;  // each camera's, about a random axis of its own
  double position_mm = 0.0;   // each camera's, in a random direction of its own
  double skew_s = 0.0;        // each camera's picture is late by up to half of this, or early
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();  // of the solids, in the world
};

// What the paper's errors are taken for where they come all together: "an estimated 1 pixel of error for the
// rotation parameters" (24 degrees, which we take as the vertical angle, over 243 lines) and "sub-millimeter"
// for the position (Our Experience), cameras that aren't synchronised, up to a video frame apart before a
// hand at 500 mm/s (ours). Its cameras have "about a 2% color variation", of 255 levels, its planes are 1.5
// cm apart.
inline constexpr double kOnePixelDeg = 0.1;
inline constexpr double kSubMillimetreMm = 1.0;
inline constexpr double kVideoFrameS = 1.0 / 30.0;
inline const Disturbance kPaperDisturbance{.rotation_deg = kOnePixelDeg,
                                           .position_mm = kSubMillimetreMm,
                                           .skew_s = kVideoFrameS,
                                           .velocity_mm_s = {500.0, 0.0, 0.0}};
inline constexpr double kPaperNoiseLevels = 0.02 * 255.0;
inline constexpr double kPaperSpacingMm = 15.0;

// `rig` is what the cameras are; the sights believe the disturbed one.
[[nodiscard]] std::vector<oracles::Sight> DisturbedSights(const core::Rig& rig,
                                                          std::span<const recon::Solid> solids,
                                                          const Disturbance& disturbance, std::uint64_t seed);

// The rig as its calibration has it.
[[nodiscard]] std::shared_ptr<const core::Rig> BelievedRig(const core::Rig& rig,
                                                           std::span<const oracles::Sight> sights);

// One camera turned and moved as Disturbance says, for instance a head whose tracker is noisy.
[[nodiscard]] core::CameraModel DisturbedCamera(const core::CameraModel& camera,
                                                const Disturbance& disturbance, std::uint64_t seed);

// The nearest surface of any solid, as FirstSurfaceOf.
[[nodiscard]] std::optional<double> NearestHitMm(std::span<const recon::Solid> solids, const recon::Ray& ray);

// The paper's sampling: planes across the view's axis at whole multiples of `spacing_mm`, front to back; a
// pixel has the depth of the first plane whose point `contains` answers for. Parallel over rows.
[[nodiscard]] recon::DepthMap PictureOnPlanes(const core::CameraModel& view,
                                              const Eigen::AlignedBox3d& workspace_mm, double spacing_mm,
                                              const std::function<bool(const Eigen::Vector3d&)>& contains,
                                              int stride);

}  // namespace elbowroom::accuracy
