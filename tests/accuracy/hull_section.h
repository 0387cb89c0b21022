// How wide a hull is across a long thin thing, such as a finger.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>

#include "recon/hull/ray.h"
#include "recon/hull/visual_hull_declared.h"
#include "tests/oracles/analytic_hull.h"

namespace elbowroom::accuracy {

// A hull, exact or slow, as a section asks it.
struct SectionQueries {
  std::function<bool(const Eigen::Vector3d& x_in_world)> contains;
  // From a point inside to where the ray leaves the hull first, but no farther than `most_mm`.
  std::function<double(const recon::Ray&, double most_mm)> way_out_mm;
};

[[nodiscard]] SectionQueries QueriesOf(const recon::VisualHull& hull);      // exact, FirstOutside()
[[nodiscard]] SectionQueries QueriesOf(const oracles::AnalyticHull& hull);  // a march of kWayOutStepMm
inline constexpr double kWayOutStepMm = 0.25;

// The plane across a finger at its middle, and the direction in it that a viewer sees the width along.
struct SectionPlane {
  Eigen::Vector3d middle_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_in_world = Eigen::Vector3d::UnitZ();    // unit, along the finger
  Eigen::Vector3d across_in_world = Eigen::Vector3d::UnitX();  // unit, across axis and line of sight
};

// Throws: PreconditionError for an eye in line with the axis.
[[nodiscard]] SectionPlane SectionSeenFrom(const Eigen::Vector3d& eye_in_world,
                                           const Eigen::Vector3d& middle_in_world,
                                           const Eigen::Vector3d& axis_in_world);

// Extents of the section between two parallel lines.
struct SectionWidths {
  double seen_mm = 0.0;      // along `across`
  double smallest_mm = 0.0;  // of all directions in the plane
  double largest_mm = 0.0;
  Eigen::AlignedBox2d bounds_mm;  // about the middle: x along `across`, y away from the viewer
};

// The widths of the hull in the plane. Of the points that are no more than kNearMm from the middle, on a
// lattice of 1 mm, one in the middle of those inside is taken; from there rays in the plane find the hull's
// outline, closer together where it is far or bent. Where the section is convex (that of a finger alone is)
// the smallest width is exact to 0.1 mm, the largest to 0.5 mm (moving_finger_test); elsewhere it is the part
// that this point sees. Rays end after kFarthestMm. Nothing: no hull near the middle.
inline constexpr double kNearMm = 15.0;
inline constexpr double kFarthestMm = 300.0;
[[nodiscard]] std::optional<SectionWidths> MeasureSection(const SectionQueries& hull,
                                                          const SectionPlane& plane);

// The width along `across` that a viewer sees of that section on planes across the line of sight at whole
// multiples of `spacing_mm` from the eye, exactly (IntervalsInHull). Lines of sight are taken as parallel,
// and a finger is the same for kStretchMm along its axis to either side, which is where oblique planes cut
// it. Nothing: the section lies between two planes.
inline constexpr double kStretchMm = 30.0;
[[nodiscard]] std::optional<double> WidthOnPlanes(const recon::VisualHull& hull, const SectionPlane& plane,
                                                  const SectionWidths& section,
                                                  const Eigen::Vector3d& eye_in_world, double spacing_mm);

}  // namespace elbowroom::accuracy
