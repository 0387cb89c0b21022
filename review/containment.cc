#include "review/containment.h"

#include "recon/hull/visual_hull.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::BallAnswer;

class InsideSearch {
 public:
  InsideSearch(const recon::VisualHull& hull, const core::RigidTransform& world_from_part, double cell_mm,
               InsideCells* cells, std::int64_t* queries)
      : hull_(hull),
        world_from_part_(world_from_part),
        cell_mm_(cell_mm),
        cells_(*cells),
        queries_(*queries) {}

  [[nodiscard]] std::optional<Vector3d> Run() { return Visit(cells_.Root(), {}); }

 private:
  [[nodiscard]] std::optional<Vector3d> Visit(const InsideCells::Cell& cell, recon::UndecidedCameras open) {
    const bool is_inside = cells_.IsInside(cell), is_last = cell.box.sizes().maxCoeff() <= cell_mm_;
    // A cell without surface is inside or outside as a whole, as its centre is. For the smallest cells only
    // the centre is asked about.
    if (!is_inside && (is_last || !cells_.MayHoldSurface(cell))) return std::nullopt;
    const Vector3d center_in_world = world_from_part_ * Vector3d(cell.box.center());
    const BallAnswer answer = is_last ? BallAnswer::kMixed : Ask(cell, center_in_world, &open);
    if (answer == BallAnswer::kOutside) return std::nullopt;
    ++queries_;
    if (is_inside && hull_.Contains(center_in_world, open)) return center_in_world;
    // The hull reaches no face, so a cell that is wholly in the hull holds none: it is outside as its centre
    // is.
    if (is_last || (answer == BallAnswer::kInside && !is_inside)) return std::nullopt;
    for (int child = 0; child < 8; ++child)
      if (std::optional<Vector3d> found = Visit(cells_.Child(cell, child), open)) return found;
    return std::nullopt;
  }

  // The answer for the cell's ball or, where that is mixed, for the cell itself.
  BallAnswer Ask(const InsideCells::Cell& cell, const Vector3d& center_in_world,
                 recon::UndecidedCameras* open) {
    ++queries_;
    const BallAnswer answer = hull_.Classify(center_in_world, cell.radius_mm(), open);
    if (answer != BallAnswer::kMixed) return answer;
    ++queries_;
    const Vector3d half_mm = 0.5 * cell.box.sizes();
    return hull_.Classify(
        recon::WorldShape::Box(center_in_world, world_from_part_.rotation * half_mm.asDiagonal()), open);
  }

  const recon::VisualHull& hull_;
  const core::RigidTransform& world_from_part_;
  double cell_mm_;
  InsideCells& cells_;
  std::int64_t& queries_;
};

}  // namespace

std::optional<Vector3d> FindHullInside(const recon::VisualHull& hull,
                                       const core::RigidTransform& world_from_part, double cell_mm,
                                       InsideCells* cells, std::int64_t* queries) {
  if (!cells->part().is_closed()) return std::nullopt;
  return InsideSearch(hull, world_from_part, cell_mm, cells, queries).Run();
}

}  // namespace elbowroom::review
