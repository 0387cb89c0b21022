#include "recon/paper_methods/grid_sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "recon/paper_methods/plane_sweep_kernel.h"
#include "recon/paper_methods/sweep_askers.h"
#include "recon/paper_methods/swept_tile.h"

namespace elbowroom::recon {
namespace {

// One a camera and triangle, for one plane.
using GridPositions = std::vector<std::vector<std::optional<GridTriangle>>>;

struct GridTile {
  SweptTile swept;
  std::array<std::size_t, kSweepTilePixels> triangle_of{};
  std::vector<std::size_t> triangles;  // each once
  std::int64_t tested_points = 0;
};

GridTile MakeTile(const SweepRays& rays, const PlaneGrid& grid, int x0, int y0) {
  GridTile tile{MakeSweptTile(rays, x0, y0), {}, {}, 0};
  for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
    tile.triangle_of[i] =
        grid.TriangleOf(x0 + static_cast<int>(i) % kSweepTilePx, y0 + static_cast<int>(i) / kSweepTilePx);
    if (std::ranges::find(tile.triangles, tile.triangle_of[i]) == tile.triangles.end())
      tile.triangles.push_back(tile.triangle_of[i]);
  }
  return tile;
}

// A tile's pixels counted from its first, in place of rays.
SweepTile PixelsOfATile() {
  SweepTile pixels;
  for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
    const std::size_t column = i % kSweepTilePx, row = i / kSweepTilePx;
    pixels.dx[i] = static_cast<float>(column);
    pixels.dy[i] = static_cast<float>(row);
  }
  return pixels;
}

class GridSweep {
 public:
  GridSweep(const SweepSpace& space, const PlaneGrid& grid)
      : space_(space), grid_(grid), askers_(AskersOf(space)), pixels_(PixelsOfATile()) {
    for (int y0 = 0; y0 < space.rays().height_px(); y0 += kSweepTilePx)
      for (int x0 = 0; x0 < space.rays().width_px(); x0 += kSweepTilePx)
        tiles_.push_back(MakeTile(space.rays(), grid, x0, y0));
  }

  void Run() {
    GridPositions positions(askers_.size());
    for (int plane = 0; plane < space_.plane_count(); ++plane) {
      const double depth_mm = space_.DepthMmOf(plane);
      for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] = grid_.PositionsOf(space_.cameras()[i], depth_mm);
      tbb::parallel_for(std::size_t{0}, tiles_.size(), [&](std::size_t i) {
        for (const std::size_t triangle : tiles_[i].triangles)
          Test(depth_mm, positions, triangle, &tiles_[i]);
      });
    }
  }

  void CopyTo(DepthMap* picture) const {
    for (const GridTile& tile : tiles_) tile.swept.CopyTo(picture);
  }

  [[nodiscard]] std::int64_t tested_points() const {
    std::int64_t sum = 0;
    for (const GridTile& tile : tiles_) sum += tile.tested_points;
    return sum;
  }

 private:
  // Asks the tile's pixels in one triangle that aren't hit yet.
  void Test(double depth_mm, const GridPositions& positions, std::size_t triangle, GridTile* tile) const {
    SweptTile& swept = tile->swept;
    SweepMarks marks;
    std::int64_t open_pixels = 0;
    for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
      if (tile->triangle_of[i] != triangle || swept.open[i] == 0.0F) continue;
      marks.open[i] = 1.0F;
      ++open_pixels;
    }
    if (open_pixels == 0) return;
    tile->tested_points += open_pixels;
    marks.seen.fill(space_.exterior_is_object() ? 0.0F : 1.0F);
    const SweepBox box = BoxAt(space_, depth_mm * swept.rays.center.homogeneous());
    if (!AskSweepBox(swept.rays, box, &marks)) return;
    for (std::size_t c = 0; c < askers_.size(); ++c)
      if (!AskSweepCamera(pixels_, AskerOn(c, positions[c][triangle], swept), &marks)) return;
    swept.TakeHits(marks, depth_mm);
  }

  // A camera without lens, whose points in its frame are the positions in homogeneous coordinates. Without
  // positions they are behind the camera, which is exterior.
  [[nodiscard]] SweepAsker AskerOn(std::size_t camera, const std::optional<GridTriangle>& positions,
                                   const SweptTile& tile) const {
    SweepAsker asker = askers_[camera];
    asker.lens = SweepLens::kIdeal;
    asker.max_radius_squared = std::numeric_limits<float>::infinity();
    asker.fx = asker.fy = 1.0F;
    asker.skew = asker.cx = asker.cy = 0.0F;
    asker.points = {{0.0F, 0.0F, -1.0F}, {}, {}};
    if (!positions) return asker;
    const CoverageTexture& coverage = space_.cameras()[camera].coverage;
    const GridTriangle counted = positions->CountedFrom({coverage.left_px, coverage.top_px});
    const Eigen::Vector3d origin = counted.origin + tile.x0 * counted.along_x + tile.y0 * counted.along_y;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      asker.points.origin[axis] = static_cast<float>(origin[i]);
      asker.points.along_x[axis] = static_cast<float>(counted.along_x[i]);
      asker.points.along_y[axis] = static_cast<float>(counted.along_y[i]);
    }
    return asker;
  }

  const SweepSpace& space_;
  const PlaneGrid& grid_;
  std::vector<SweepAsker> askers_;
  SweepTile pixels_;
  std::vector<GridTile> tiles_;
};

}  // namespace

std::int64_t SweepGrid(const SweepSpace& space, const PlaneGrid& grid, DepthMap* picture) {
  GridSweep sweep(space, grid);
  sweep.Run();
  sweep.CopyTo(picture);
  return sweep.tested_points();
}

}  // namespace elbowroom::recon
