// The cells over the workspace in which swept volume is kept.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace elbowroom::recon {

using GridCell = Eigen::Vector3i;

// Cell (i, j, k) reaches from At(i, j, k) to At(i + 1, j + 1, k + 1). The outermost cells end at the
// workspace's faces.
struct SweptGrid {
  Eigen::Vector3d origin_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d cell_mm = Eigen::Vector3d::Ones();
  GridCell cells = GridCell::Zero();  // in each direction
  double rounding_mm = 0.0;           // room for the rounding of coordinates, to float32 too

  [[nodiscard]] Eigen::Vector3d At(const GridCell& corner) const {
    return origin_in_world + cell_mm.cwiseProduct(corner.cast<double>());
  }
  [[nodiscard]] double DiagonalMm() const { return cell_mm.norm(); }
  // A corner whose value is nearer to 0 than this counts as inside.
  [[nodiscard]] double LeastMm() const { return cell_mm.minCoeff() / 256.0; }
};

// Cells as large as possible that are no longer than `edge_mm` in any direction and fill the workspace.
// Throws: core::Error{kRange} when edge_mm isn't positive, or needs 2^20 cells a side or more.
[[nodiscard]] SweptGrid MakeSweptGrid(const Eigen::AlignedBox3d& workspace_mm, double edge_mm);

// The place of a cube of cells along a curve that passes every cube of its size: cubes near to each other are
// near on it. Coordinates from -1 to 2^20.
[[nodiscard]] std::uint64_t CurveKey(const GridCell& cube);

}  // namespace elbowroom::recon
