#include "recon/exact_view/hull_view.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "recon/exact_view/hull_normals.h"
#include "recon/exact_view/tile_cast.h"
#include "recon/exact_view/view_pencils.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// Marks the pixels of a box as misses.
void Clear(const PixelBox& box, HullView* view) {
  if (box.right <= box.x) return;
  const auto columns = static_cast<std::size_t>(box.right - box.x);
  for (int row = box.y; row < box.bottom; ++row) {
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(view->width_px) +
                              static_cast<std::size_t>(box.x);
    std::fill_n(view->depth_mm.data() + first, columns, 0.0F);
    if (!view->surface.empty()) std::fill_n(view->surface.data() + first, columns, HullSurface());
    if (!view->normal_in_world.empty())
      std::fill_n(view->normal_in_world[first].data(), 3 * columns, 0.0F);  // one piece of memory
  }
}

PixelBox Common(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

PixelBox Around(const PixelBox& a, const PixelBox& b) {
  if (b.right <= b.x) return a;
  if (a.right <= a.x) return b;
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

// Casts a view's rays. Holds all that doesn't depend on the pixel.
class Caster {
 public:
  // `stale`: the pixels of the view that are to be cleared.
  Caster(const VisualHull& hull, const ViewRays& rays, const PixelBox& stale, HullView* view)
      : hull_(hull), pencils_(hull, rays), rays_(rays), stale_(stale), view_(*view) {
    view_.edges = pencils_.edges();
    if (!view_.normal_in_world.empty()) normals_.emplace(hull, rays);
  }

  void Run() {
    tbb::enumerable_thread_specific<Worker> workers([this] {
      Worker worker;
      worker.rays.is_perspective = rays_.projection() == Projection::kPerspective;
      for (const auto& pencil : pencils_.cameras())
        worker.cameras.push_back({&pencil->cast(), pencil->starts_inside() ? ~0U : 0U});
      for (const auto& pencil : pencils_.visibility_outlines())
        worker.visibility_outlines.push_back({&pencil->cast(), pencil->starts_inside() ? ~0U : 0U});
      return worker;
    });
    constexpr int kSizePx = ViewPencils::kLargestSquarePx;
    const int across = (rays_.width_px() + kSizePx - 1) / kSizePx;
    const int down = (rays_.height_px() + kSizePx - 1) / kSizePx;
    tbb::parallel_for(0, across * down, [&](int i) {
      Worker& worker = workers.local();
      const int x = i % across * kSizePx, y = i / across * kSizePx;
      Clear(Common(stale_, {x, y, x + kSizePx, y + kSizePx}), &view_);
      worker.squares.clear();
      pencils_.AddSquaresIn(x, y, &worker.squares);
      for (const PixelBox& square : worker.squares) Work(square, &worker);
    });
    for (const Worker& worker : workers) {
      view_.hit_pixels += worker.hit_pixels;
      view_.hits = Around(view_.hits, worker.hit_box);
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
    std::vector<PixelBox> squares;
    std::vector<TileCamera> cameras;
    std::vector<TileCamera> visibility_outlines;
    std::int64_t hit_pixels = 0;
    PixelBox hit_box;
    std::int64_t cast_pixels = 0;
  };

  void Work(const PixelBox& square, Worker* worker) {
    for (int y = square.y; y < square.bottom; y += kTilePx)
      for (int x = square.x; x < square.right; x += kTilePx) CastTileAt(x, y, worker);
  }

  void CastTileAt(int x, int y, Worker* worker) {
    rays_.FillTile(x, y, worker->rays.u, worker->rays.v);
    LabelConcentric(pencils_.cameras(), x, y, &worker->cameras);
    LabelConcentric(pencils_.visibility_outlines(), x, y, &worker->visibility_outlines);
    CastTile(worker->rays, pencils_.box(), worker->cameras, worker->visibility_outlines,
             normals_ || !view_.surface.empty(), &worker->scratch, &worker->hits);
    worker->cast_pixels += std::min(kTilePx, rays_.width_px() - x) * std::min(kTilePx, rays_.height_px() - y);
    if (worker->hits.count > 0) Record(x, y, worker);
  }

  [[nodiscard]] bool IsPixel(int x, int y) const { return x < rays_.width_px() && y < rays_.height_px(); }

  // Sets the labels of cameras at the rays' origin: there each ray has one label all along.
  void LabelConcentric(const ViewPencils::Pencils& pencils, int x, int y,
                       std::vector<TileCamera>* cameras) const {
    for (std::size_t i = 0; i < pencils.size(); ++i)
      if (pencils[i]->is_concentric()) (*cameras)[i].starts_inside = LabelsAlong(*pencils[i], x, y);
  }
  [[nodiscard]] std::uint32_t LabelsAlong(const EpipolarEdges& pencil, int x, int y) const {
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
    worker->hit_box = Around(worker->hit_box, {x, y, std::min(x + kTilePx, rays_.width_px()),
                                               std::min(y + kTilePx, rays_.height_px())});
    const int columns = std::min(kTilePx, rays_.width_px() - x);
    for (int row = 0; row < std::min(kTilePx, rays_.height_px() - y); ++row) {
      const std::size_t first =
          static_cast<std::size_t>(y + row) * static_cast<std::size_t>(rays_.width_px()) +
          static_cast<std::size_t>(x);
      std::copy_n(hits.depth_mm + row * kTilePx, columns, view_.depth_mm.data() + first);
      if (!normals_ && view_.surface.empty()) continue;
      for (int column = 0; column < columns; ++column) {
        const int i = row * kTilePx + column;
        if (hits.camera[i] == TileHits::kMiss) continue;
        const std::size_t pixel = first + static_cast<std::size_t>(column);
        const HullSurface surface =
            SurfaceOf(hull_, hits.camera[i], ContourEdgeOf(hits.camera[i], hits.edge[i]));
        if (!view_.surface.empty()) view_.surface[pixel] = surface;
        if (normals_)
          view_.normal_in_world[pixel] = normals_->Of(surface, x + column, y + row, hits.depth_mm[i]);
      }
    }
  }

  [[nodiscard]] std::uint32_t ContourEdgeOf(std::int32_t caster, std::int32_t edge) const {
    if (caster == TileHits::kNoCamera) return 0;
    const EpipolarEdges& pencil = pencils_.Caster(static_cast<std::size_t>(caster));
    return pencil.cast().edges[static_cast<std::size_t>(edge)].edge;
  }

  const VisualHull& hull_;
  ViewPencils pencils_;
  const ViewRays& rays_;
  const PixelBox stale_;
  HullView& view_;
  std::optional<HullNormals> normals_;
};

}  // namespace

HullView ViewHull(const VisualHull& hull, const ViewRays& rays, const HullViewOptions& options,
                  HullView kept) {
  HullView view;
  view.width_px = rays.width_px(), view.height_px = rays.height_px();
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  const bool can_keep = kept.width_px == view.width_px && kept.height_px == view.height_px &&
                        kept.surface.empty() != options.surfaces &&
                        kept.normal_in_world.empty() != options.normals;
  view.depth_mm = std::move(kept.depth_mm);
  view.depth_mm.resize(pixels);
  view.surface = std::move(kept.surface);
  view.surface.resize(options.surfaces ? pixels : 0);
  view.normal_in_world = std::move(kept.normal_in_world);
  view.normal_in_world.resize(options.normals ? pixels : 0);
  view.skipped_pixels = static_cast<std::int64_t>(pixels);
  const PixelBox stale = can_keep ? kept.hits : PixelBox{0, 0, view.width_px, view.height_px};
  if (hull.IsEmpty()) {
    Clear(stale, &view);
  } else {
    Caster(hull, rays, stale, &view).Run();
  }
  return view;
}

HullView ViewHull(const VisualHull& hull, const core::CameraModel& view, const HullViewOptions& options) {
  return ViewHull(hull, ViewRays(view), options);
}

}  // namespace elbowroom::recon
