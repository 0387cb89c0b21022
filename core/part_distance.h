// How far a point is from a part's surface, and where that surface is nearest.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "core/bvh.h"

namespace elbowroom::core {

struct NearestOnPart {
  double distance_mm = std::numeric_limits<double>::infinity();
  Eigen::Vector3d position_in_part = Eigen::Vector3d::Zero();
  std::uint32_t triangle = 0;  // of the mesh
  // No point of the box that was asked about is nearer to the part than this.
  double box_lower_mm = std::numeric_limits<double>::infinity();
};

// A box with edges along any three perpendicular directions. Without half edges it is a point.
struct BoxInPart {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  // Columns: from the centre to the middles of three faces.
  Eigen::Matrix3d half_edges = Eigen::Matrix3d::Zero();
  // The tight bound is worked out only if it can reach this. Otherwise, and always if this is infinite, the
  // bound is that of the ball around the box.
  double enough_mm = std::numeric_limits<double>::infinity();
  // The point found may be this much farther away than the nearest one, and the bound this much smaller than
  // that of the planes of all triangles. It saves most of the work where much of the part is about equally
  // near: the centre of a sphere is as far from each of its triangles.
  double allowance_mm = 0.0;
};

// The nearest point of the triangle a, b, c. A triangle without area is its sides.
[[nodiscard]] Eigen::Vector3d NearestOnTriangle(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                                const Eigen::Vector3d& b, const Eigen::Vector3d& c);

// Without an allowance, the distance of the box's centre is exact but for double's rounding
// (part_distance_test). The distance of the box is a lower bound: a triangle is convex, so all of it lies
// beyond the plane through its nearest point across the way to the centre, and the box's distance to that
// plane is no larger than to the triangle. The boxes and discs of the tree's nodes are convex, too. A node
// that is small compared with the box is bounded by one plane. `likely`: a triangle that is probably near,
// which saves work. The part must have triangles. Thread: any.
[[nodiscard]] NearestOnPart FindNearest(const TriangleTree& part, const BoxInPart& box,
                                        std::uint32_t likely = 0);

// A stretch of a box, in coordinates from -1 to 1 along one of its half edges.
struct NearStretch {
  double from = 1.0;
  double to = -1.0;
  [[nodiscard]] bool is_empty() const { return from > to; }
  [[nodiscard]] double length() const { return to - from; }  // below 0 if it is empty
};

// A stretch along half edge `axis` that holds all points of the box that are nearer to the part than
// `within_mm`, by the planes of FindNearest. With an allowance (of any size) it may be longer than it must be
// by a twentieth of the half edge. A stretch that is longer than `longest` isn't worked out: then it is the
// whole, from -1 to 1. The caller allows for rounding. Thread: any.
[[nodiscard]] NearStretch FindNearStretch(const TriangleTree& part, const BoxInPart& box, Eigen::Index axis,
                                          double within_mm, std::uint32_t likely, double longest = 2.0);

}  // namespace elbowroom::core
