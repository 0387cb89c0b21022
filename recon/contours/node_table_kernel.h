// Cubic interpolation in a grid of positions, by the processor's vectors.
#pragma once

#include <Eigen/Core>
#include <span>

namespace elbowroom::recon {

// Positions at the nodes of a grid, row by row. At least four nodes across and down.
struct NodeTable {
  const Eigen::Vector2d* nodes = nullptr;
  int across = 0;
  int down = 0;
};

// For each place, in units of nodes from the first one, the position there by the Lagrange cubic of the 4 x 4
// nodes around it, at the border of the outermost ones. NaN where one of these nodes is NaN. `found` has room
// for one position a place. The width of the processor's vectors doesn't change a bit of the result.
void InterpolateNodes(const NodeTable& table, std::span<const Eigen::Vector2d> places,
                      Eigen::Vector2d* found);

}  // namespace elbowroom::recon
