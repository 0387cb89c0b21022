#include "recon/paper_methods/swept_tile.h"

#include <algorithm>
#include <cstddef>

namespace elbowroom::recon {

void SweptTile::TakeHits(const SweepMarks& marks, double plane_mm) {
  for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
    if (marks.open[i] * marks.seen[i] == 0.0F) continue;
    depth_mm[i] = static_cast<float>(plane_mm);
    open[i] = 0.0F;
    --open_pixels;
  }
}

void SweptTile::CopyTo(DepthMap* picture) const {
  const int width = std::min(kSweepTilePx, picture->width_px - x0),
            height = std::min(kSweepTilePx, picture->height_px - y0);
  for (int y = 0; y < height; ++y) {
    std::copy_n(depth_mm.data() + std::ptrdiff_t{y} * kSweepTilePx, width,
                picture->depth_mm.data() + std::ptrdiff_t{y0 + y} * picture->width_px + x0);
  }
}

SweptTile MakeSweptTile(const SweepRays& rays, int x0, int y0) {
  SweptTile tile;
  tile.x0 = x0;
  tile.y0 = y0;
  tile.rays = rays.TileAt(x0, y0);
  for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
    const bool has_ray = tile.rays.dx[i] == tile.rays.dx[i];
    const bool is_pixel = x0 + static_cast<int>(i) % kSweepTilePx < rays.width_px() &&
                          y0 + static_cast<int>(i) / kSweepTilePx < rays.height_px();
    tile.open[i] = has_ray && is_pixel ? 1.0F : 0.0F;
    tile.open_pixels += has_ray && is_pixel ? 1 : 0;
  }
  return tile;
}

}  // namespace elbowroom::recon
