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
  std::vector<std::vector<std::size_t>> markers_of_points;  // for each view: Cap::markers' place, one a point
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
  // What the pose would follow if all corners of a marker moved together: the sums of J^T W K, with K the
  // derivative of a corner's pixel by a shift of its marker (mm); one a marker of the cap.
  std::vector<Eigen::Matrix<double, 6, 3>> by_marker;
  // The same for all edges of all markers that move inwards by a pixel.
  Eigen::Matrix<double, 6, 1> by_edges = Eigen::Matrix<double, 6, 1>::Zero();
  double squared_sigmas = 0.0;  // the sum of the squared residuals in variances
  double unexplained = 0.0;     // the same sum, in variances that have the markers' places in them
  double squared_px2 = 0.0;     // and in px^2
  int corners = 0;              // that agree
  int corners_in_all = 0;
};
[[nodiscard]] CapEvidence EvidenceFor(const Cap& cap, const CapProblem& problem,
                                      const core::RigidTransform& world_from_head);

}  // namespace elbowroom::recon
