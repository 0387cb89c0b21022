// Where in the workspace the hull's surface is: an octree's leaves.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/progress.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

using GridPoint = Eigen::Vector3i;

// Grid point (i, j, k) stands at origin + edge * (i, j, k); the outermost layer lies outside the workspace.
struct HullGrid {
  Eigen::Vector3d origin_in_world = Eigen::Vector3d::Zero();
  double edge_mm = 1.0;
  GridPoint cells = GridPoint::Zero();  // in each direction

  [[nodiscard]] Eigen::Vector3d At(const GridPoint& p) const { return AtSteps(p.cast<double>()); }
  [[nodiscard]] Eigen::Vector3d AtSteps(const Eigen::Vector3d& steps) const {
    return origin_in_world + edge_mm * steps;
  }
};

// Over the workspace with a cell's margin. Throws: core::Error{kRange} when edge_mm isn't positive or the
// grid would have 2^20 cells a side or more.
[[nodiscard]] HullGrid MakeHullGrid(const Eigen::AlignedBox3d& workspace_mm, double edge_mm);

// A cube of kBlockCells^3 cells that the surface may cross.
inline constexpr int kBlockCells = 8;
struct HullBlock {
  GridPoint corner = GridPoint::Zero();
  std::vector<std::uint8_t> cameras;  // that may see a change in it; to all others it is wholly object
  bool is_in_workspace = false;       // all of it
  bool is_seen = true;                // all of it by some camera, where the rig asks for that
};

// The order of the blocks at these corners: along the octree's curve.
[[nodiscard]] std::uint64_t MortonKey(const GridPoint& corner);

struct HullBlocks {
  std::vector<HullBlock> blocks;  // in MortonKey's order
  std::int64_t queries = 0;       // balls asked, of one camera each
};

// An octree, refined where some camera's ball query says mixed; a camera to which a cube is wholly object
// isn't asked about the cube's parts. Throws: core::Error{kCancelled}; PreconditionError for a rig of more
// than 255 cameras.
[[nodiscard]] HullBlocks FindHullBlocks(const VisualHull& hull, const HullGrid& grid,
                                        const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::recon
