#include "recon/swept_volume/swept_descent.h"

#include <utility>

namespace elbowroom::recon {
namespace {

struct Descent {
  const VisualHull& hull;
  const SweptGrid& grid;
  SweptWork* work;
  std::vector<ReachedTile> reached;

  // `cube` is counted in cubes of `side` tiles.
  void Visit(int side, const GridCell& cube, UndecidedCameras open) {
    const GridCell low = cube * (side * kTileCells);
    if ((low.array() >= grid.cells.array()).any()) return;
    if (side == 1) {
      reached.push_back({cube, open});
      return;
    }
    const double cells = side * kTileCells;
    ++work->balls;
    const BallAnswer answer =
        hull.Classify(grid.At(low) + 0.5 * cells * grid.cell_mm,
                      0.5 * cells * grid.DiagonalMm() * (1.0 + 1e-9) + grid.rounding_mm, &open);
    if (answer == BallAnswer::kOutside) return;
    for (int child = 0; child < 8; ++child)
      Visit(side / 2, 2 * cube + GridCell(child & 1, (child >> 1) & 1, child >> 2), open);
  }
};

}  // namespace

std::vector<ReachedTile> FindReachedTiles(const VisualHull& hull, const SweptGrid& grid, SweptWork* work) {
  Descent descent{hull, grid, work, {}};
  if (hull.IsEmpty()) return {};
  int side = 1;
  while (side * kTileCells < grid.cells.maxCoeff()) side *= 2;
  descent.Visit(side, GridCell::Zero(), {});
  return std::move(descent.reached);
}

}  // namespace elbowroom::recon
