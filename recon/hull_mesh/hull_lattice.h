// Which points of a grid are in the hull, and where the grid's edges leave it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "recon/hull/visual_hull_declared.h"
#include "recon/hull_mesh/hull_blocks.h"
#include "recon/hull_mesh/point_labels.h"

namespace elbowroom::recon {

// An edge of the grid: within a block, or on its near faces.
struct BlockEdge {
  std::uint8_t axis = 0;
  std::array<std::uint8_t, 3> low{};  // its lower end, in the block
  bool low_is_inside = false;
  std::uint8_t near_faces = 0;  // bit a: coordinate a of the lower end is 0
  std::uint16_t index = 0;      // among all edges that begin in the block or on its faces
};

class HullLattice {
 public:
  // Prepares the hull. `hull` and `grid` must outlive the lattice.
  HullLattice(const VisualHull& hull, const HullGrid& grid);

  // Which of a block's grid points the hull contains. A point has the same label in all blocks that share it.
  // `queries` grows by the labels asked, of one camera each.
  [[nodiscard]] BlockBits LabelsOf(const HullBlock& block, std::int64_t* queries) const;

  // For each of some edges of a block whose ends have different labels: the point where it first leaves the
  // hull, counted from the end that is inside, but at least edge / 2048 from its ends.
  void FindExits(const HullBlock& block, std::span<const BlockEdge> edges,
                 std::span<Eigen::Vector3d> exits_in_world) const;

 private:
  [[nodiscard]] BlockBits InWorkspace(const GridPoint& corner) const;
  std::int64_t KeepSeen(const GridPoint& corner, BlockBits* bits) const;
  void OfferFaces(const HullBlock& block, std::span<const BlockEdge> edges, std::span<double> shares) const;
  [[nodiscard]] double BisectedExit(const Eigen::Vector3d& inside, const Eigen::Vector3d& outside) const;

  const VisualHull& hull_;
  const HullGrid& grid_;
  // By camera.
  std::vector<GridView> views_;
  std::vector<ContourCellsView> cells_;
  std::vector<ContourCellsView> outlines_;  // what each camera can see; empty unless the rig says `abstain`
  // The grid points in the workspace: along each axis from `first` to `last`.
  GridPoint first_, last_;
};

}  // namespace elbowroom::recon
