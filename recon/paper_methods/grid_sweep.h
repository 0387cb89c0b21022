// The plane sweep with picture positions from a grid, as the paper has it.
#pragma once

#include <cstdint>

#include "recon/images/depth_map.h"
#include "recon/paper_methods/plane_grid.h"
#include "recon/paper_methods/sweep_space.h"

namespace elbowroom::recon {

// Writes the depths that `grid`, one over the space's view, makes of the planes, and returns how many points
// were asked. A position between the corners of a cell has no bound that follows from the lens, so nothing is
// settled for many pixels at once: plane by plane, each pixel without a hit is asked.
std::int64_t SweepGrid(const SweepSpace& space, const PlaneGrid& grid, DepthMap* picture);

}  // namespace elbowroom::recon
