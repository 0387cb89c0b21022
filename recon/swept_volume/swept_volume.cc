#include "recon/swept_volume/swept_volume.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/infinity.h"
#include "recon/hull/visual_hull.h"
#include "recon/swept_volume/swept_burial.h"
#include "recon/swept_volume/swept_descent.h"
#include "recon/swept_volume/swept_surface.h"

namespace elbowroom::recon {
namespace {

// Boxes that differ by no more than this share of their coordinates are one: the rounding of the grid's.
constexpr double kSameBoxShare = 1e-9;

// What one tile is to add.
struct TileTask {
  std::vector<std::pair<std::size_t, UndecidedCameras>> hulls;  // by number, in their order
  PlacedTile* tile = nullptr;
  SweptWork work;
};

// How far an object that a camera sees in the rectangle around a cell's picture can be from a corner of the
// cell, in diagonals of the cell (docs/keep_out.md). A cell of a larger grid may reach beyond the workspace.
double ReachInDiagonals(const core::Rig& rig, const SweptGrid& grid) {
  const double diagonal_mm = grid.DiagonalMm();
  const bool has_more =
      !rig.workspace_mm.isApprox({grid.At(GridCell::Zero()), grid.At(grid.cells)}, kSameBoxShare);
  double reach = 0.0;
  for (const core::CameraModel& camera : rig.cameras) {
    double least_z = core::kInfinity;
    for (int c = 0; c < 8; ++c) {
      const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(c);
      least_z = std::min(least_z, (camera.cam_from_world() * rig.workspace_mm.corner(corner)).z());
    }
    if (has_more) least_z -= diagonal_mm;
    if (!(least_z > diagonal_mm)) return core::kInfinity;
    const double slope = camera.max_radius();
    reach = std::max(reach, std::sqrt(2.0 + slope * slope) * least_z / (least_z - diagonal_mm));
  }
  return reach;
}

}  // namespace

struct SweptVolume::Impl {
  SweptGrid grid;
  SweptVolumeOptions options;
  SweptTiles tiles;
  SweptWork work;
  std::int64_t most_bytes = 0;
  std::map<std::shared_ptr<const core::Rig>, double> reaches;  // in diagonals

  [[nodiscard]] std::vector<TileTask> TasksFor(std::span<const HullSpan> hulls) {
    std::vector<std::vector<ReachedTile>> reached(hulls.size());
    std::vector<SweptWork> works(hulls.size());
    tbb::parallel_for(std::size_t{0}, hulls.size(),
                      [&](std::size_t i) { reached[i] = FindReachedTiles(*hulls[i].hull, grid, &works[i]); });
    std::map<std::uint64_t, TileTask> tasks;
    for (std::size_t i = 0; i < hulls.size(); ++i) {
      work += works[i];
      for (const ReachedTile& at : reached[i]) {
        TileTask& task = tasks[CurveKey(at.tile)];
        task.hulls.emplace_back(i, at.open);
        if (task.tile == nullptr) task.tile = TileAt(at.tile);
      }
    }
    std::vector<TileTask> all;
    all.reserve(tasks.size());
    for (auto& [key, task] : tasks) all.push_back(std::move(task));
    return all;
  }

  void FindReaches(std::span<const HullSpan> hulls) {
    for (const HullSpan& span : hulls)
      if (!reaches.contains(span.hull->shared_rig()))
        reaches[span.hull->shared_rig()] = ReachInDiagonals(span.hull->rig(), grid);
  }

  PlacedTile* TileAt(const GridCell& tile) {
    return &tiles.try_emplace(CurveKey(tile), PlacedTile{tile, SweptTile(grid, tile * kTileCells)})
                .first->second;
  }

  void CountBytes() {
    const std::int64_t live =
        std::ranges::count_if(tiles, [](const auto& item) { return !item.second.cells.is_buried(); });
    const std::int64_t bytes = live * SweptTile::Bytes();
    most_bytes = std::max(most_bytes, bytes);
    if (bytes <= options.most_bytes) return;
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format(
            "swept volume: an edge of {:.4g} mm needs more than {} MiB of memory for cells; choose --edge "
            "{:.4g} or more",
            options.edge_mm, options.most_bytes >> 20U, 2.0 * options.edge_mm));
  }
};

SweptVolume::SweptVolume(const Eigen::AlignedBox3d& workspace_mm, const SweptVolumeOptions& options)
    : impl_(new Impl{MakeSweptGrid(workspace_mm, options.edge_mm), options, {}, {}, 0, {}}) {}

SweptVolume::~SweptVolume() = default;

void SweptVolume::Add(std::span<const HullSpan> hulls, const std::stop_token& stop) {
  constexpr const char* kWhat = "sweeping a volume";
  core::ThrowIfStopped(stop, kWhat);
  std::vector<TileTask> tasks = impl_->TasksFor(hulls);
  impl_->CountBytes();
  impl_->FindReaches(hulls);
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
    TileTask& task = tasks[i];
    for (const auto& [hull, open] : task.hulls) {
      if (stop.stop_requested()) return;
      task.tile->cells.Add(*hulls[hull].hull, open, hulls[hull].seconds, &task.work);
    }
  });
  core::ThrowIfStopped(stop, kWhat);
  std::vector<PlacedTile*> added;
  for (const TileTask& task : tasks) {
    impl_->work += task.work;
    added.push_back(task.tile);
  }
  UpdateBuried(added, &impl_->tiles);
}

SweptMesh SweptVolume::Mesh(const core::Progress& progress, const std::stop_token& stop) const {
  return ExtractSurface(impl_->tiles, impl_->grid, progress, stop);
}

double SweptVolume::BoundMm() const {
  double reach = 0.0;
  for (const auto& [rig, diagonals] : impl_->reaches) reach = std::max(reach, diagonals);
  return (1.0 + reach) * impl_->grid.DiagonalMm() + impl_->grid.rounding_mm;
}

const SweptGrid& SweptVolume::grid() const { return impl_->grid; }
const SweptWork& SweptVolume::work() const { return impl_->work; }
std::int64_t SweptVolume::bytes() const { return impl_->most_bytes; }

}  // namespace elbowroom::recon
