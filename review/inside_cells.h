// Where the inside of a closed part is, cell by cell.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/bvh.h"

namespace elbowroom::review {

// True if the point is inside a closed mesh: its winding number, the sum of a ray's signed crossings, isn't
// 0. Bodies of one mesh may overlap, lie in each other or occur twice; a point in any of them is inside.
// Cavities, whose faces point into them, are outside. x_in_part is in the mesh's frame.
[[nodiscard]] bool IsInsideClosedMesh(const core::TriangleTree& part, const Eigen::Vector3d& x_in_part);

// An octree over a part's bounds. A cell is worked out when it is first asked about, and kept: the same cells
// are asked about frame after frame, wherever the part stands. Frame: the part's. Thread: one at a time.
class InsideCells {
 public:
  struct Cell {
    Eigen::AlignedBox3d box;
    std::uint32_t at = 0;

    [[nodiscard]] double radius_mm() const { return 0.5 * box.diagonal().norm() * (1.0 + 1e-12); }
  };

  // `part` must outlive it.
  explicit InsideCells(const core::TriangleTree& part) : part_(part), facts_(1) {}

  [[nodiscard]] const core::TriangleTree& part() const { return part_; }
  [[nodiscard]] Cell Root() const { return {part_.bounds(), 0}; }
  [[nodiscard]] Cell Child(const Cell& cell, int which);

  // Whether the cell's centre is inside the part.
  [[nodiscard]] bool IsInside(const Cell& cell);
  // Whether the ball around the cell may hold surface.
  [[nodiscard]] bool MayHoldSurface(const Cell& cell);

 private:
  struct Facts {
    double to_surface_mm = -1.0;    // from the centre; below 0: not asked yet
    std::uint32_t triangle = 0;     // the nearest one, or one that is probably near
    std::uint32_t first_child = 0;  // eight side by side; 0: none yet
    bool is_inside = false;
  };
  const Facts& FactsOf(const Cell& cell);

  const core::TriangleTree& part_;
  std::vector<Facts> facts_;
};

}  // namespace elbowroom::review
