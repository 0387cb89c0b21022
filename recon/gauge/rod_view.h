// One camera's silhouette, as the gauge looks at it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/soft_mask.h"
#include "recon/contours/contour.h"
#include "recon/contours/undistorted_plane.h"

namespace elbowroom::recon {

// How far a contour's crossing may be off, in pixels along the line between two pixel centres.
struct BoundaryLimits {
  double ready_px = 0.5;  // a ready mask's: it lies between two centres and is taken to be halfway
  // A segmented one's: docs/gauge.md measures it on rods.
  double segmented_bias_px = 0.8;    // common to a side of the rod
  double segmented_noise_px = 0.15;  // standard deviation of each crossing
};

// A crossing of the contour with a line between two neighbouring pixel centres.
struct ContourPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // UndistortedPlane units
  Eigen::Vector2d step_in_plane =
      Eigen::Vector2d::UnitX();  // how it moves if the crossing moves by a pixel along its line
  Eigen::Vector2d along =
      Eigen::Vector2d::UnitX();  // unit: the contour's direction there, object to the left
  bool is_at_border = false;     // of the picture: not where an object ends
};

// How far off a line a point of a straight edge may be: `px` pixels across it.
[[nodiscard]] double AcrossLimit(const ContourPoint& point, const Eigen::Vector2d& normal, double px);

struct RodView {
  std::shared_ptr<const UndistortedPlane> plane;
  bool is_ready = true;  // a ready mask: its crossings are halfway between centres
  std::vector<ContourPoint> points;
  std::vector<std::vector<std::uint32_t>> loops;  // of points, in the contour's direction, each closed

  [[nodiscard]] const core::CameraModel& camera() const { return plane->camera(); }
  // The direction of sight through a position of the plane; unit.
  [[nodiscard]] Eigen::Vector3d SightInWorld(const Eigen::Vector2d& position) const;
};

[[nodiscard]] RodView MakeRodView(std::shared_ptr<const UndistortedPlane> plane, const core::SoftMask& mask);

}  // namespace elbowroom::recon
