// The corners of a cap in all cameras as a least squares problem, and the places where its search begins.
#pragma once

#include <span>
#include <vector>

#include "recon/calibration/planar_pose.h"
#include "recon/head_pose/cap_pose.h"

namespace elbowroom::recon {

// The cameras that see a marker, with its corners in `head`.
struct CapProblem {
  std::vector<PosedView> views;
  int markers = 0;
};

[[nodiscard]] CapProblem ProblemOf(const Cap& cap, std::span<const CapCamera> cameras,
                                   std::span<const CapSighting> sightings, double least_sigma_px);

// world_from_head by each marker alone, both poses of its plane.
[[nodiscard]] std::vector<core::RigidTransform> StartsOf(const Cap& cap, std::span<const CapCamera> cameras,
                                                         std::span<const CapSighting> sightings);

// Distinct minima that are found from the starts, the best one first.
[[nodiscard]] std::vector<PoseFit> MinimaOf(const CapProblem& problem,
                                            std::span<const core::RigidTransform> starts);

// How each corner that agrees with a pose tells of it.
struct CapEvidence {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();  // as CapPose::covariance
  double squared_sigmas = 0.0;  // the sum of the squared residuals in variances
  double squared_px2 = 0.0;     // and in px^2
  int corners = 0;              // that agree
  int corners_in_all = 0;
};
[[nodiscard]] CapEvidence EvidenceFor(const CapProblem& problem, const core::RigidTransform& world_from_head);

}  // namespace elbowroom::recon
