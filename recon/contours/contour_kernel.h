// Exact questions to a contour's edges, several at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "recon/contours/contour_cells_view.h"

namespace elbowroom::recon {

// A grid before a camera: x and y are in focal lengths of pixels, mm; z in mm. Point (x, y, z) stands at
// (x * steps[0] + y * steps[1]) + (origin + z * steps[2]), to the last bit, for whoever works it out.
struct GridView {
  std::array<double, 3> origin{};
  std::array<std::array<double, 3>, 3> steps{};
};

// Some points of a grid, by coordinate.
struct GridPoints {
  static constexpr std::size_t kMost = 64;
  alignas(64) std::array<std::array<double, kMost>, 3> at;
  std::size_t count = 0;
};

// Instead of a share of a way: nothing is crossed; or one can't be worked out.
inline constexpr double kNoCrossing = 2.0;
inline constexpr double kUnknownCrossing = -1.0;

// Whether the label changes between a cell's centre and a position in the cell, by the cell's edges; behind
// them kEdgesBehind more may be read.
[[nodiscard]] bool LabelDiffersInCell(std::span<const ContourCellsView::Edge> edges,
                                      const std::array<double, 2>& centre_px,
                                      const std::array<double, 2>& position_px);

// Bit i: the contour labels point i object, as ContourMap::IsObject does its position. Points that aren't in
// front of the camera are exterior.
[[nodiscard]] std::uint64_t LabelPoints(const GridView& grid, const ContourCellsView& raster,
                                        const GridPoints& points);

// Shares of some ways between grid points; what is behind the last of them means nothing.
struct WayShares {
  alignas(64) std::array<double, GridPoints::kMost> at;
};

// Lowers share i to that of the straight way between two points at which the contour is first crossed in
// the picture, if it is; to kUnknownCrossing where an end isn't in front of the camera. For ways of a few
// cells: cost follows their box.
void LowerToCrossings(const GridView& grid, const ContourCellsView& raster, const GridPoints& from,
                      const GridPoints& to, WayShares* shares);

// Points of a grid that span something convex.
struct ConvexCorners {
  static constexpr std::size_t kCount = 8;

  GridPoints points;
  // Three of its edges, from corner to corner: an edge of the contour beside them is found to be beside it.
  std::array<std::array<std::size_t, 2>, 3> sides;

  [[nodiscard]] static const ConvexCorners& OfBox();       // (+-1, +-1, +-1)
  [[nodiscard]] static const ConvexCorners& OfTriangle();  // (0, 0, 0), (1, 0, 0), (0, 1, 0)
};

// Whether no edge comes within `slack_px` of what something convex covers in the picture. False where that
// isn't certain: an edge about between the corners, a corner that isn't in front of the camera, more than
// kMostConvexRows rows of cells.
inline constexpr std::int32_t kMostConvexRows = 64;
[[nodiscard]] bool IsClearOfEdges(const GridView& grid, const ConvexCorners& corners,
                                  const ContourCellsView& raster, double slack_px);

}  // namespace elbowroom::recon
