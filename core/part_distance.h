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

// A box with edges along any three perpendicular directions; none: a point.
struct BoxInPart {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  // Columns: from the centre to the middles of three faces.
  Eigen::Matrix3d half_edges = Eigen::Matrix3d::Zero();
  // A bound is worth work only to reach this; infinite: not worth any, the box's own ball will do.
  double enough_mm = std::numeric_limits<double>::infinity();
};

// The nearest point of the triangle a, b, c; of one without area, of its sides.
[[nodiscard]] Eigen::Vector3d NearestOnTriangle(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                                const Eigen::Vector3d& b, const Eigen::Vector3d& c);

// The distance of the box's centre is exact but for double's rounding (part_distance_test). That of the box
// is a lower bound: a triangle is convex, so the plane through its nearest point keeps all of it on the far
// side, and the box is compared with that plane. Triangles that together are small next to the box are kept
// by one plane, that of their own box. `likely`: a triangle that is probably near, which saves work and
// changes nothing. The part has triangles. Thread: any.
[[nodiscard]] NearestOnPart FindNearest(const TriangleTree& part, const BoxInPart& box,
                                        std::uint32_t likely = 0);

// The stretch of a box, along one of its half edges from -1 to 1, in which its points may be near.
struct NearStretch {
  double from = 1.0;
  double to = -1.0;
  [[nodiscard]] bool is_empty() const { return from > to; }
};

// All points of the box that are nearer to the part than `within_mm` are in the stretch along half edge
// `axis`, by the same planes. Rounding is the caller's. Thread: any.
[[nodiscard]] NearStretch FindNearStretch(const TriangleTree& part, const BoxInPart& box, Eigen::Index axis,
                                          double within_mm);

}  // namespace elbowroom::core
