// Marching squares asked cell by cell, in the distorted picture: what contours, maps and hulls are held to.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/soft_mask.h"

namespace elbowroom::recon {

// A silhouette as its definition has it: no polygon, no lens, no grid.
class Lattice {
 public:
  Lattice(const core::SoftMask& silhouette, bool exterior_is_object);

  // The label of a position of the picture plane, in pixels (finite).
  [[nodiscard]] bool At(const Eigen::Vector2d& pixel) const;

  // Share of the way from pixel (x, y) to its neighbour (x + dx, y + dy), of the other label, at which the
  // boundary is.
  [[nodiscard]] double CrossingShare(int x, int y, int dx, int dy) const;

  [[nodiscard]] bool IsObject(int x, int y) const;  // of a pixel, or the exterior's

 private:
  [[nodiscard]] bool IsInside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  [[nodiscard]] bool CornerIsWithin(int x, int y, int dx, int dy, double along_x, double along_y) const;

  const core::BitMask mask_;
  bool exterior_;
  int width_, height_;
  std::vector<int> levels_;  // by pixel, -1 where there is none
};

}  // namespace elbowroom::recon
