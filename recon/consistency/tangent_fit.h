// Where exactly the boundary is at its outermost point in one direction.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "recon/consistency/tangents.h"
#include "recon/contours/contour.h"

namespace elbowroom::recon {

// How far the boundary reaches beyond one of its vertices.
struct OutermostFit {
  double along_px = 0.0;   // of the outermost point from the vertex, along the tangent
  double beyond_px = 0.0;  // across it: negative is inwards
  double sigma_px = 0.0;   // of `beyond_px`
};

// A parabola, by least squares, through the vertices around `vertex` that are less than options.depth_px
// inwards of it and options.reach_px beside it. `outwards`: unit, in the plane. `plane_per_px`: plane units
// for each of the picture's pixels across the tangent. Nothing: fewer than five vertices, or a boundary that
// no parabola follows to three times its noise, as at a corner.
[[nodiscard]] std::optional<OutermostFit> FitOutermost(const Contour& contour, std::uint32_t vertex,
                                                       const Eigen::Vector2d& outwards, double plane_per_px,
                                                       const TangentOptions& options);

}  // namespace elbowroom::recon
