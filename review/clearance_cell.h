// A box of space in the search for a clearance.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "recon/hull/visual_hull.h"

namespace elbowroom::review {

struct ClearanceCell {
  double lower_mm = 0.0;  // no point of the cell is nearer to the part
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  // parallel to the world's axes
  std::uint32_t triangle = 0;                      // nearest to the centre, or probably near
  recon::UndecidedCameras open;

  // Of two cells in a heap, the one that is nearer to the part comes out first.
  [[nodiscard]] bool operator<(const ClearanceCell& other) const { return lower_mm > other.lower_mm; }
};

}  // namespace elbowroom::review
