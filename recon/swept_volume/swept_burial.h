// Which cells of a swept volume lie so deep in it that nothing can bring its surface there.
#pragma once

#include <span>

#include "recon/swept_volume/swept_surface.h"

namespace elbowroom::recon {

// Brings covered and buried cells up to date after hulls were added to some tiles, in parallel.
void UpdateBuried(std::span<PlacedTile* const> added, SweptTiles* tiles);

}  // namespace elbowroom::recon
