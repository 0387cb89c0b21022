#include "recon/hull_view.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "recon/hull_normals.h"
#include "recon/tile_cast.h"
#include "recon/view_pencils.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// All that doesn't depend on the pixel.
class Caster {
 public:
  Caster(const VisualHull& hull, const ViewRays& rays, HullView* view)
      : hull_(hull), pencils_(hull, rays), rays_(rays), view_(*view) {
    view_.edges = pencils_.edges();
  }

  void Run() {
    tbb::enumerable_thread_specific<Worker> workers([this] {
      Worker worker;
      worker.rays.is_perspective = rays_.projection() == Projection::kPerspective;
      for (const auto& pencil : pencils_.cameras())
        worker.cameras.push_back({&pencil->cast(), pencil->starts_inside() ? ~0U : 0U});
      for (const auto& pencil : pencils_.sights())
        worker.sights.push_back({&pencil->cast(), pencil->starts_inside() ? ~0U : 0U});
      return worker;
    });
    constexpr int kSizePx = ViewPencils::kLargestSquarePx;
    const int across = (rays_.width_px() + kSizePx - 1) / kSizePx;
    const int down = (rays_.height_px() + kSizePx - 1) / kSizePx;
    tbb::parallel_for(0, across * down, [&](int i) {
      Worker& worker = workers.local();
      worker.squares.clear();
      pencils_.AddSquaresIn(i % across * kSizePx, i / across * kSizePx, &worker.squares);
      for (const PixelSquare& square : worker.squares) Work(square, &worker);
    });
    for (const Worker& worker : workers) {
      view_.hit_pixels += worker.hit_pixels;
      view_.crossings_met += worker.scratch.crossings_met;
      view_.cast_pixels += worker.cast_pixels;
    }
    view_.skipped_pixels = std::int64_t{view_.width_px} * view_.height_px - view_.cast_pixels;
  }

 private:
  struct Worker {
    TileRays rays;
    TileHits hits;
    TileScratch scratch;
    std::vector<PixelSquare> squares;
    std::vector<TileCamera> cameras;
    std::vector<TileCamera> sights;
    std::int64_t hit_pixels = 0;
    std::int64_t cast_pixels = 0;
  };

  void Work(const PixelSquare& square, Worker* worker) {
    for (int y = square.y; y < square.bottom; y += kTilePx)
      for (int x = square.x; x < square.right; x += kTilePx) CastTileAt(x, y, worker);
  }

  void CastTileAt(int x, int y, Worker* worker) {
    rays_.FillTile(x, y, worker->rays.u, worker->rays.v);
    LabelConcentric(pencils_.cameras(), x, y, &worker->cameras);
    LabelConcentric(pencils_.sights(), x, y, &worker->sights);
    CastTile(worker->rays, pencils_.box(), worker->cameras, worker->sights, !view_.surface.empty(),
             &worker->scratch, &worker->hits);
    worker->cast_pixels += std::min(kTilePx, rays_.width_px() - x) * std::min(kTilePx, rays_.height_px() - y);
    if (worker->hits.count > 0) Record(x, y, worker);
  }

  [[nodiscard]] bool IsPixel(int x, int y) const { return x < rays_.width_px() && y < rays_.height_px(); }

  // What cameras at the rays' origin say of them, of each in its own direction.
  void LabelConcentric(const ViewPencils::Pencils& pencils, int x, int y,
                       std::vector<TileCamera>* cameras) const {
    for (std::size_t i = 0; i < pencils.size(); ++i)
      if (pencils[i]->is_concentric()) (*cameras)[i].starts_inside = LabelsAlong(*pencils[i], x, y);
  }
  [[nodiscard]] std::uint32_t LabelsAlong(const EdgePencil& pencil, int x, int y) const {
    std::uint32_t labels = 0;
    for (int i = 0; i < kTileRays; ++i) {
      const int ray_x = x + i % kTilePx, ray_y = y + i / kTilePx;
      if (IsPixel(ray_x, ray_y) && pencil.IsObjectAlong(rays_.At(ray_x, ray_y)))
        labels |= 1U << static_cast<unsigned>(i);
    }
    return labels;
  }

  void Record(int x, int y, Worker* worker) {
    const TileHits& hits = worker->hits;
    worker->hit_pixels += hits.count;
    const int columns = std::min(kTilePx, rays_.width_px() - x);
    for (int row = 0; row < std::min(kTilePx, rays_.height_px() - y); ++row) {
      const std::size_t first =
          static_cast<std::size_t>(y + row) * static_cast<std::size_t>(rays_.width_px()) +
          static_cast<std::size_t>(x);
      std::copy_n(hits.depth_mm + row * kTilePx, columns, view_.depth_mm.data() + first);
      if (view_.surface.empty()) continue;
      for (int i = row * kTilePx; i < row * kTilePx + columns; ++i) {
        if (hits.camera[i] == TileHits::kMiss) continue;
        view_.surface[first + static_cast<std::size_t>(i % kTilePx)] =
            SurfaceOf(hull_, hits.camera[i], ContourEdge(hits.camera[i], hits.edge[i]));
      }
    }
  }

  [[nodiscard]] std::uint32_t ContourEdge(std::int32_t caster, std::int32_t edge) const {
    if (caster == TileHits::kNoCamera) return 0;
    const EdgePencil& pencil = pencils_.Caster(static_cast<std::size_t>(caster));
    return pencil.cast().edges[static_cast<std::size_t>(edge)].edge;
  }

  const VisualHull& hull_;
  ViewPencils pencils_;
  const ViewRays& rays_;
  HullView& view_;
};

}  // namespace

HullView ViewHull(const VisualHull& hull, const ViewRays& rays, const HullViewOptions& options) {
  HullView view;
  view.width_px = rays.width_px(), view.height_px = rays.height_px();
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  view.depth_mm.assign(pixels, 0.0F);
  if (options.surfaces || options.normals) view.surface.assign(pixels, {});
  view.skipped_pixels = static_cast<std::int64_t>(pixels);
  if (!hull.IsEmpty()) Caster(hull, rays, &view).Run();
  if (options.normals) {
    view.normal_in_world = view.hit_pixels > 0
                               ? NormalsOf(hull, rays, view)
                               : std::vector<Eigen::Vector3f>(pixels, Eigen::Vector3f::Zero());
  }
  return view;
}

HullView ViewHull(const VisualHull& hull, const core::CameraModel& view, const HullViewOptions& options) {
  return ViewHull(hull, ViewRays(view), options);
}

}  // namespace elbowroom::recon
