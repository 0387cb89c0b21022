// Which tiles of a swept volume a hull may reach.
#pragma once

#include <vector>

#include "recon/hull/visual_hull.h"
#include "recon/swept_volume/swept_grid.h"
#include "recon/swept_volume/swept_tile.h"

namespace elbowroom::recon {

struct ReachedTile {
  GridCell tile;          // its first cell is kTileCells times this
  UndecidedCameras open;  // the cameras that may exclude parts of it
};

// By an octree over the grid, in its order. A hull of a workspace that doesn't meet the grid's reaches none.
[[nodiscard]] std::vector<ReachedTile> FindReachedTiles(const VisualHull& hull, const SweptGrid& grid,
                                                        SweptWork* work);

}  // namespace elbowroom::recon
