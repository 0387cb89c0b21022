// A small triangle's pieces, each decided by its centre, many at a time.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

// A triangle cut into sides x sides congruent pieces by lines along its sides.
struct CutTriangle {
  static constexpr int kMostSides = 8;

  Eigen::Vector3d a, b, c;  // in world
  int sides = 1;            // 1 to kMostSides

  [[nodiscard]] int pieces() const { return sides * sides; }
  [[nodiscard]] Eigen::Vector3d CentreOf(int piece) const;  // in world
};

// Bit i: the hull contains the centre of piece i, as VisualHull::Contains decides, but for the rounding of
// the centre's coordinates. Only open cameras are asked. Thread: any.
[[nodiscard]] std::uint64_t PiecesInHull(const VisualHull& hull, const CutTriangle& triangle,
                                         const UndecidedCameras& open);

}  // namespace elbowroom::recon
