// A contour's vertices in square cells, for the nearest one far away.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "recon/contours/contour.h"

namespace elbowroom::recon {

// A ContourMap is exact near a contour; this is exact everywhere, but for the vertices' spacing: they are a
// pixel's diagonal apart at most, so that the contour is nearer than its nearest vertex by less than
// kVertexSpacingPx. Frame: undistorted plane, px. The contour must outlive it. Immutable. Thread: any.
inline constexpr double kVertexSpacingPx = 1.5;

class VertexCells {
 public:
  explicit VertexCells(const Contour& contour);

  // Infinite where there are no vertices.
  [[nodiscard]] double NearestPx(const Eigen::Vector2d& position) const;

 private:
  [[nodiscard]] Eigen::Vector2i CellOf(const Eigen::Vector2d& position) const;
  [[nodiscard]] std::size_t Index(const Eigen::Vector2i& cell) const;
  void VisitRing(const Eigen::Vector2i& middle, int ring, const Eigen::Vector2d& position,
                 double* nearest_px) const;

  Eigen::AlignedBox2d bounds_;
  Eigen::Vector2i across_{0, 0};
  std::vector<std::vector<Eigen::Vector2d>> cells_;
};

}  // namespace elbowroom::recon
