// One camera's labels of a block's grid points.
#pragma once

#include <cstdint>

#include "core/camera_model.h"
#include "recon/contours/contour_cells_view.h"
#include "recon/contours/contour_kernel.h"
#include "recon/hull_mesh/hull_blocks.h"
#include "recon/hull_mesh/label_kernel.h"

namespace elbowroom::recon {

// A grid's points in cam, x and y times the focal length.
[[nodiscard]] GridView ViewGrid(const core::CameraModel& camera, double focal_px, const HullGrid& grid);

// Clears the bits of those points in `mixed`, of the block at `corner`, that the raster's contour doesn't
// call object, exactly.
void SettleMixed(const GridView& grid, const ContourCellsView& raster, const GridPoint& corner,
                 const BlockBits& mixed, BlockBits* bits);

}  // namespace elbowroom::recon
