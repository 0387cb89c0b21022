// A cylinder that lines of sight touch: the fit, and how each line's error arrives in what is measured.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "recon/gauge/rod_view.h"

namespace elbowroom::recon {

struct Cylinder {
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();  // on the axis
  Eigen::Vector3d axis_in_world = Eigen::Vector3d::UnitZ();  // unit
  double radius_mm = 0.0;
};

// A line of sight through a point of a silhouette's straight edge, which touches the rod.
struct TangentSight {
  int camera = 0;
  int side = 1;  // of the rod in that camera's picture: 1 or -1
  Eigen::Vector3d eye_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d sight_in_world = Eigen::Vector3d::UnitZ();  // unit
  const RodView* view = nullptr;
  const ContourPoint* point = nullptr;
};

// Where a sight touches, to first order (docs/gauge.md). `inward` is the normal of the plane through sight
// and axis direction, towards the axis.
struct Touch {
  Eigen::Vector3d inward_in_world = Eigen::Vector3d::UnitX();
  double along_mm = 0.0;     // along the axis, from the cylinder's point
  double distance_mm = 0.0;  // along the sight
  double error_mm = 0.0;     // how much farther from the axis than the radius
  double mm_per_px = 0.0;    // how much farther it is when the crossing moves out by a pixel along its line
};

// Throws: PreconditionError for a sight parallel to the axis.
[[nodiscard]] Touch TouchOf(const Cylinder& cylinder, const TangentSight& sight);

// Rows: sights. Columns: a shift of the axis along two directions across it, a turn towards them [mm per mm],
// and the radius.
using TangentJacobian = Eigen::Matrix<double, Eigen::Dynamic, 5>;

struct CylinderFit {
  Cylinder cylinder;
  std::array<Eigen::Vector3d, 2> across_in_world;  // unit
  std::vector<Touch> touches;                      // one a sight
  TangentJacobian jacobian;                        // of error_mm
  bool is_found = false;                           // false: the sights don't tell the axis
};

// Least squares of the errors, each over its limit: those with `is_used`, or all. From `start` on, by Gauss
// and Newton.
[[nodiscard]] CylinderFit FitCylinder(const Cylinder& start, std::span<const TangentSight> sights,
                                      std::span<const double> limits_mm);

// The same derivative inverted: how the axis (four numbers, as in TangentJacobian) moves with each sight's
// error, when only the sights with `is_used` take part and the radius is free. 4 x sights; empty if they
// don't tell the axis.
[[nodiscard]] Eigen::Matrix<double, 4, Eigen::Dynamic> AxisGain(const CylinderFit& fit,
                                                                std::span<const double> limits_mm,
                                                                const std::vector<bool>& is_used);

// How error_mm changes with the parameters of the sight's camera, in the order of recon::ParameterBlock.
[[nodiscard]] Eigen::VectorXd ErrorByParameters(const Touch& touch, const TangentSight& sight);

}  // namespace elbowroom::recon
