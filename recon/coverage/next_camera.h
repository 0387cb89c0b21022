// Where one more camera would help the most.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/progress.h"
#include "recon/coverage/coverage_figures.h"
#include "recon/coverage/rig_coverage.h"

namespace elbowroom::recon {

// The space that a new camera is to serve.
struct ServedSpace {
  std::vector<Eigen::Vector3d> points_mm;  // of the workspace; at least one
  // Near parts; may be empty. Else the points of either list count for half, whatever their number.
  std::vector<Eigen::Vector3d> near_points_mm = {};
  Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();  // what cameras are to look at
};

struct NextCameraOptions {
  double ceiling_mm = std::numeric_limits<double>::infinity();  // no place has a larger z
  int directions = 60;              // tried around the middle, over a whole sphere; > 0
  int proposals = 3;                // at most; > 0
  std::size_t tried_points = 160;   // of each list, with which all places are compared; > 0
  std::size_t final_points = 4000;  // with which the best are compared and their figures made; > 0
};

struct ProposedCamera {
  core::RigidTransform cam_from_world;
  Eigen::Vector3d center_mm;
  Eigen::Vector3d look_at_mm;
  CoverageFigures after;                      // over the workspace
  std::optional<CoverageFigures> near_after;  // near the parts
  double gain = 0.0;                          // see GainOf; 0: no better than without
};

struct NextCamera {
  std::size_t lens_of = 0;  // the camera whose lens it has: that which sees most points
  std::size_t tried = 0;    // places and directions
  std::size_t points = 0;   // over which `before` and `after` are
  CoverageFigures before;
  std::optional<CoverageFigures> near_before;
  std::vector<ProposedCamera> best;  // the best first, no two beside each other; empty: none is a gain
};

// Tries places on shells around the middle, at the distances of the rig's cameras, looking at the middle and
// at the worst region. No place is below the workspace's floor unless a camera of the rig is, nor in the
// workspace unless one is. The same for any number of threads. Throws: Error{kCancelled}.
[[nodiscard]] NextCamera FindNextCamera(const CalibratedRig& rig, const CoverageOptions& options,
                                        const ServedSpace& space, const NextCameraOptions& search,
                                        const core::Progress& progress = {},
                                        const std::stop_token& stop = {});

// The mean over the nodes of ln(uncertainty before / after) + ln(phantom fraction before / after): 0.1 is
// about a tenth less. A node without a value counts as one with three times the 95th percentile of the
// uncertainty before, and a phantom fraction of 1; fractions below 0.02 count as 0.02.
[[nodiscard]] double GainOf(std::span<const CoverageNode> before, std::span<const CoverageNode> after);

}  // namespace elbowroom::recon
