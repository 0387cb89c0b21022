// A silhouette's boundary as straight edges in its camera's picture plane.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/soft_mask.h"
#include "recon/contours/undistorted_plane.h"

namespace elbowroom::recon {

// From one vertex to another, object on the side where cross(to - from, p - from) > 0.
struct ContourEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

// Closed loops: each vertex is the end of exactly one edge and the start of exactly one.
struct Contour {
  std::vector<Eigen::Vector2d> vertices;  // UndistortedPlane units
  std::vector<ContourEdge> edges;
  std::vector<std::uint32_t> edge_from;  // by vertex: the edge that starts there
  std::vector<std::uint32_t> edge_to;    // ... that ends there
};

// Marching squares over the lattice of pixel centres, with the exterior label around the picture. A vertex is
// where the boundary crosses the line between two neighbouring centres: at the place that core::SoftMask
// gives, or on the picture's border against the exterior. Straight edges join the vertices. Where two object
// pixels touch across a corner they are joined. Pixels that the lens's domain doesn't reach are exterior.
[[nodiscard]] Contour TraceContour(const core::SoftMask& silhouette, bool exterior_is_object,
                                   const UndistortedPlane& plane);

// The label of one position by the parity of the edges to its left: slow, needs nothing prepared.
[[nodiscard]] bool IsObjectByParity(const Contour& contour, bool exterior_is_object,
                                    const Eigen::Vector2d& position);

// Direction of the boundary at an edge, taken over this edge and the `kTangentReach` edges before and after
// it, so that a ready mask's staircase gives the direction of the line that it stands for. Zero for a loop of
// no more edges than these.
inline constexpr int kTangentReach = 3;
[[nodiscard]] Eigen::Vector2d SmoothTangent(const Contour& contour, std::uint32_t edge);

// The normal of the plane through the camera's centre along SmoothTangent: unit, away from the object. Where
// that tangent is zero, the edge's own direction is taken.
[[nodiscard]] Eigen::Vector3d OutwardNormalInCam(const Contour& contour, std::uint32_t edge, double focal_px);

[[nodiscard]] double DistanceToEdge(const Contour& contour, std::uint32_t edge,
                                    const Eigen::Vector2d& position);

}  // namespace elbowroom::recon
