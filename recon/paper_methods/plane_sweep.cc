#include "recon/paper_methods/plane_sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <optional>
#include <vector>

#include "recon/paper_methods/grid_sweep.h"
#include "recon/paper_methods/plane_sweep_kernel.h"
#include "recon/paper_methods/sweep_askers.h"
#include "recon/paper_methods/sweep_space.h"
#include "recon/paper_methods/swept_tile.h"

namespace elbowroom::recon {
namespace {

constexpr int kRootPx = 2 * kSweepTilePx;

// Sweeps a square of pixels front to back, whole regions at a time.
class RootSweep {
 public:
  RootSweep(const SweepSpace& space, const std::vector<SweepAsker>& askers, int x0, int y0)
      : space_(space), askers_(askers), x0_(x0), y0_(y0) {}

  [[nodiscard]] std::int64_t tested_points() const { return tested_points_; }

  void Run() {
    Visit({x0_, y0_, x0_ + kRootPx, y0_ + kRootPx, 0, space_.plane_count()}, space_.AllQuestions());
  }

  // The plain sweep: settles nothing but whole tiles.
  void RunPlain() {
    ForEachTile([this](int x0, int y0) {
      const SweepRegion tile{x0, y0, x0 + kSweepTilePx, y0 + kSweepTilePx, 0, space_.plane_count()};
      const std::optional<OpenQuestions> open = space_.Narrow(tile, space_.AllQuestions());
      if (!open) return;
      for (int plane = 0; plane < tile.end_plane && TileAt(x0, y0).open_pixels > 0; ++plane)
        Test({tile.x0, tile.y0, tile.x1, tile.y1, plane, plane + 1}, *open);
    });
  }

  void CopyTo(DepthMap* picture) const {
    for (const std::optional<SweptTile>& tile : tiles_)
      if (tile) tile->CopyTo(picture);
  }

 private:
  SweptTile& TileAt(int x0, int y0) {
    std::optional<SweptTile>& tile =
        tiles_[static_cast<std::size_t>((y0 - y0_) / kSweepTilePx * 2 + (x0 - x0_) / kSweepTilePx)];
    if (!tile) tile = MakeSweptTile(space_.rays(), x0, y0);
    return *tile;
  }

  void Visit(const SweepRegion& region, const OpenQuestions& asked) {
    const bool is_tile = region.x1 - region.x0 == kSweepTilePx;
    if (is_tile && TileAt(region.x0, region.y0).open_pixels == 0) return;
    const std::optional<OpenQuestions> open = space_.Narrow(region, asked);
    if (!open) return;
    const int planes = region.end_plane - region.first_plane;
    if (is_tile && (planes == 1 || open->IsSettled())) {
      Test(region, *open);
    } else if (planes > 1 && (is_tile || space_.IsDeep(region))) {
      SweepRegion half = region;
      half.end_plane = region.first_plane + planes / 2;
      Visit(half, *open);
      half.first_plane = half.end_plane;
      half.end_plane = region.end_plane;
      Visit(half, *open);
    } else {
      ForEachTile([&](int x0, int y0) {
        Visit({x0, y0, x0 + kSweepTilePx, y0 + kSweepTilePx, region.first_plane, region.end_plane}, *open);
      });
    }
  }

  // Calls visit(x0, y0) with the root's tiles in the picture.
  template <typename OnTile>
  void ForEachTile(const OnTile& visit) {
    for (int i = 0; i < 4; ++i) {
      const int x0 = x0_ + i % 2 * kSweepTilePx, y0 = y0_ + i / 2 * kSweepTilePx;
      if (x0 < space_.rays().width_px() && y0 < space_.rays().height_px()) visit(x0, y0);
    }
  }

  // Asks all open pixels of a tile on the region's first plane. If the region has more planes it is settled:
  // all open pixels are hit on the first one.
  void Test(const SweepRegion& region, const OpenQuestions& open) {
    SweptTile& tile = TileAt(region.x0, region.y0);
    const double depth_mm = space_.DepthMmOf(region.first_plane);
    SweepMarks marks{tile.open, {}};
    marks.seen.fill(open.is_seen ? 1.0F : 0.0F);
    if (!open.IsSettled()) tested_points_ += tile.open_pixels;
    if (AskAll(tile.rays, depth_mm * tile.rays.center.homogeneous(), open, &marks))
      tile.TakeHits(marks, depth_mm);
  }

  bool AskAll(const SweepTile& rays, const Eigen::Vector3d& center_in_view, const OpenQuestions& open,
              SweepMarks* marks) const {
    if (!open.in_workspace && !AskSweepBox(rays, BoxAt(space_, center_in_view), marks)) return false;
    for (std::uint64_t bits = open.cameras; bits != 0; bits &= bits - 1) {
      const auto index = static_cast<std::size_t>(std::countr_zero(bits));
      SweepAsker asker = askers_[index];
      asker.points = PointsOf(space_.cameras()[index].cam_from_view, center_in_view);
      if (!AskSweepCamera(rays, asker, marks)) return false;
    }
    return true;
  }

  const SweepSpace& space_;
  const std::vector<SweepAsker>& askers_;
  int x0_, y0_;
  std::array<std::optional<SweptTile>, 4> tiles_;  // where none was asked yet: nothing
  std::int64_t tested_points_ = 0;
};

}  // namespace

SweptView SweepPlanes(const core::Rig& rig, std::span<const core::SoftMask> masks,
                      const core::CameraModel& view, const SweepRays& rays,
                      const PlaneSweepOptions& options) {
  const SweepSpace space(rig, masks, view, rays, options);
  SweptView swept;
  DepthMap& picture = swept.picture;
  picture.width_px = view.width_px();
  picture.height_px = view.height_px();
  const auto pixels =
      static_cast<std::size_t>(picture.width_px) * static_cast<std::size_t>(picture.height_px);
  picture.depth_mm.assign(pixels, 0.0F);
  const std::vector<SweepAsker> askers = AskersOf(space);
  const int roots_x = (picture.width_px + kRootPx - 1) / kRootPx,
            roots_y = (picture.height_px + kRootPx - 1) / kRootPx;
  std::atomic<std::int64_t> tested = 0;
  if (options.undistortion_grid > 0) {
    tested = SweepGrid(space, PlaneGrid(view, options.undistortion_grid), &picture);
  } else if (space.plane_count() > 0) {
    tbb::parallel_for(0, roots_x * roots_y, [&](int root) {
      RootSweep sweep(space, askers, root % roots_x * kRootPx, root / roots_x * kRootPx);
      options.settles_regions ? sweep.Run() : sweep.RunPlain();
      sweep.CopyTo(&picture);
      tested += sweep.tested_points();
    });
  }
  picture.hit_pixels = std::count_if(picture.depth_mm.begin(), picture.depth_mm.end(),
                                     [](float depth_mm) { return depth_mm > 0.0F; });
  swept.stats.planes = space.plane_count();
  swept.stats.tested_points = tested;
  swept.stats.skipped_points = swept.stats.planes * static_cast<std::int64_t>(pixels) - tested;
  return swept;
}

SweptView SweepPlanes(const core::Rig& rig, std::span<const core::SoftMask> masks,
                      const core::CameraModel& view, const PlaneSweepOptions& options) {
  return SweepPlanes(rig, masks, view, SweepRays(view), options);
}

}  // namespace elbowroom::recon
