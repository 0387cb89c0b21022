// What a rig can do at a place of the workspace, and over all of it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "core/progress.h"
#include "core/rig.h"
#include "recon/calibration/rig_uncertainty.h"
#include "recon/coverage/ball_hull.h"

namespace elbowroom::recon {

// A rig with what its calibration tells of its errors.
struct CalibratedRig {
  core::Rig rig;
  Eigen::MatrixXd covariance = {};  // RigCalibration::covariance; empty: the cameras are taken as exact
  double noise_px = 0.3;            // of one coordinate of a point in a picture; > 0
};

// docs/coverage.md defines the four quantities. A value that a node hasn't is 0.
struct CoverageNode {
  float sigma_mm = 0.0F;      // of a triangulated point
  float footprint_mm = 0.0F;  // of a pixel, the largest over the cameras that see the node
  float phantom = 0.0F;       // share of the hull of a ball at the node that isn't the ball
  std::uint8_t cameras = 0;   // that see it; 255: so many or more
  bool has_sigma = false;
  bool has_phantom = false;
  bool in_reach = false;  // the unseen policy lets a thing at the node be in the hull
};

struct CoverageOptions {
  double ball_mm = 50.0;  // diameter of the ball; > 0
  int rings = 5;          // of BallHull
};

// Thread: any.
class RigCoverage {
 public:
  // Throws: PreconditionError as RigUncertainty and BallHull, or a ball without a size.
  RigCoverage(const CalibratedRig& rig, const CoverageOptions& options);

  [[nodiscard]] CoverageNode At(const Eigen::Vector3d& x_in_world, BallHull::Scratch* scratch) const;
  [[nodiscard]] std::vector<CoverageNode> At(std::span<const Eigen::Vector3d> points_in_world,
                                             const core::Progress& progress = {},
                                             const std::stop_token& stop = {}) const;

 private:
  struct Camera {
    core::CameraModel model;
    LensParameters lens;
  };
  std::vector<Camera> cameras_;
  RigUncertainty uncertainty_;
  BallHull ball_hull_;
  double ball_radius_mm_ = 0.0;
  bool abstains_ = false;
};

// The width of a pixel at a point, parallel to the picture and in the direction in which it is the widest,
// in mm; 0 behind the camera.
[[nodiscard]] double PixelWidthMm(const LensParameters& lens, const core::RigidTransform& cam_from_world,
                                  const Eigen::Vector3d& x_in_world);

// Nodes from a box's least corner on: x runs fastest, then y, then z.
struct CoverageGrid {
  Eigen::Vector3d first_mm;
  double edge_mm = 0.0;
  Eigen::Vector3i counts;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(counts.cast<long>().prod()); }
  [[nodiscard]] Eigen::Vector3d PointAt(std::size_t node) const;
  [[nodiscard]] std::size_t NodeAt(int x, int y, int z) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> Points() const;
};
// Throws: PreconditionError: an edge that isn't positive, or an empty box.
[[nodiscard]] CoverageGrid GridOver(const Eigen::AlignedBox3d& box_mm, double edge_mm);

}  // namespace elbowroom::recon
