// The surface at value 0 of a swept volume's tiles.
#pragma once

#include <array>
#include <map>
#include <stop_token>

#include "core/progress.h"
#include "recon/swept_volume/swept_tile.h"
#include "recon/swept_volume/swept_volume.h"

namespace elbowroom::recon {

struct PlacedTile {
  GridCell tile;  // its first cell is kTileCells times this
  SweptTile cells;
};

// By CurveKey of the tile.
using SweptTiles = std::map<std::uint64_t, PlacedTile>;

// A tile and those around it; null where there is none. Item 13 is the tile itself, steps along x follow
// each other.
using TilesAround = std::array<const SweptTile*, 27>;
[[nodiscard]] TilesAround FindAround(const SweptTiles& tiles, const GridCell& tile);

// Marching tetrahedra over all cells that have a corner inside, also those beyond the tiles. Throws: as
// SweptVolume::Mesh.
[[nodiscard]] SweptMesh ExtractSurface(const SweptTiles& tiles, const SweptGrid& grid,
                                       const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::recon
