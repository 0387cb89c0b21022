// Rigs that are not what their calibration says, and pictures on the paper's planes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
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

// `rig` is what the cameras are; the sights believe the disturbed one.
[[nodiscard]] std::vector<oracles::Sight> DisturbedSights(const core::Rig& rig,
                                                          std::span<const recon::Solid> solids,
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
