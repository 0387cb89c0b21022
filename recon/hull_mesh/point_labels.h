// One camera's labels of a block's grid points.
#pragma once

#include <cstdint>

#include "core/camera_model.h"
#include "recon/contours/contour_cells_view.h"
#include "recon/contours/contour_kernel.h"
#include "recon/hull_mesh/hull_blocks.h"
#include "recon/hull_mesh/label_kernel.h"

namespace elbowroom::recon {

// The grid in the camera's frame, with x and y times the focal length (GridView).
[[nodiscard]] GridView ViewGrid(const core::CameraModel& camera, double focal_px, const HullGrid& grid);

// Decides the points of the block at `corner` that are set in `mixed`, exactly: clears the bits of those that
// the contour doesn't label object.
void SettleMixed(const GridView& grid, const ContourCellsView& cells, const GridPoint& corner,
                 const BlockBits& mixed, BlockBits* bits);

}  // namespace elbowroom::recon
