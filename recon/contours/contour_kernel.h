// Queries of a contour for many points at once: their labels, where ways between them cross it, and whether
// something convex is clear of it. The same answers as ContourMap gives one by one, to the last bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "recon/contours/contour_cells_view.h"

namespace elbowroom::recon {

// A grid of points in a camera's frame. Point (x, y, z) of the grid stands at
// (x * steps[0] + y * steps[1]) + (origin + z * steps[2]), in this order of operations: everyone who works it
// out gets the same bits. Its third coordinate is the depth in mm; the first two are mm times the focal
// length in pixels, so that dividing them by the depth gives the position in the undistorted plane.
struct GridView {
  std::array<double, 3> origin{};
  std::array<std::array<double, 3>, 3> steps{};
};

// Some points of a grid: at[axis][i] is a coordinate of point i.
struct GridPoints {
  static constexpr std::size_t kMost = 64;
  alignas(64) std::array<std::array<double, kMost>, 3> at;
  std::size_t count = 0;
};

// In place of a crossing's share of its way (0 to 1): there is no crossing; it isn't known.
inline constexpr double kNoCrossing = 2.0;
inline constexpr double kUnknownCrossing = -1.0;

// Whether the label differs between a cell's centre and a position in the cell: it does if the straight way
// between the two crosses an odd number of the cell's edges. Reads up to kEdgesBehind edges after the span,
// which must be readable; they don't count.
[[nodiscard]] bool LabelDiffersInCell(std::span<const ContourCellsView::Edge> edges,
                                      const std::array<double, 2>& centre_px,
                                      const std::array<double, 2>& position_px);

// Bit i: point i is wanted, and it is object, by ContourMap::IsObject of its position in the plane. Points
// that aren't in front of the camera are exterior.
[[nodiscard]] std::uint64_t LabelPoints(const GridView& grid, const ContourCellsView& cells,
                                        const GridPoints& points, std::uint64_t wanted = ~std::uint64_t{0});

// A share for each of some ways between grid points. Elements after the last way mean nothing.
struct WayShares {
  alignas(64) std::array<double, GridPoints::kMost> at;
};

// Lowers share i to the one at which the straight way from from[i] to to[i] first crosses the contour in the
// picture, if it crosses it and if that is less; to kUnknownCrossing if an end isn't in front of the camera.
// Meant for ways of a few cells: all cells of a way's bounding box are looked at.
void LowerToCrossings(const GridView& grid, const ContourCellsView& cells, const GridPoints& from,
                      const GridPoints& to, WayShares* shares);

// The corners of a convex body, as points of a grid.
struct ConvexCorners {
  static constexpr std::size_t kCount = 8;

  GridPoints points;
  // Three edges of the body, as pairs of corners. A line that separates the body from a contour's edge is
  // looked for along them, along the picture's axes, and along the contour's edge.
  std::array<std::array<std::size_t, 2>, 3> sides;

  [[nodiscard]] static const ConvexCorners& OfBox();       // (+-1, +-1, +-1)
  [[nodiscard]] static const ConvexCorners& OfTriangle();  // (0, 0, 0), (1, 0, 0), (0, 1, 0)
};

// Whether every edge of the contour is sure to be farther than `slack_px` from what the convex body covers in
// the picture. False does not mean that one is nearer: it is also the answer where no separating line was
// found, where a corner isn't in front of the camera, and where the body covers more than kMostConvexRows
// rows of cells.
inline constexpr std::int32_t kMostConvexRows = 64;
[[nodiscard]] bool IsClearOfEdges(const GridView& grid, const ConvexCorners& corners,
                                  const ContourCellsView& cells, double slack_px);

}  // namespace elbowroom::recon
