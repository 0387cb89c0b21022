#include "recon/hull_view.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "recon/edge_pencil.h"
#include "recon/hull_normals.h"
#include "recon/tile_cast.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The largest square of pixels that is asked about at once.
constexpr int kLargestSquarePx = 64;
constexpr std::size_t kTilesATask = 8;

// One face of the workspace as rays (u, v) meet it: they are on its inner side from, or up to, the key
// `bound`; rays along the face, all the way where `bound` isn't negative.
struct Face {
  enum class Kind { kNotBefore, kNotAfter, kBeside } kind = Kind::kBeside;
  AffineForm bound;
};

// The faces of a box, of rays of one projection.
std::array<Face, 6> FacesOf(const Eigen::AlignedBox3d& box, const ViewRays& rays) {
  const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
  std::array<Face, 6> faces;
  for (int i = 0; i < 6; ++i) {
    const int axis = i / 2;
    const double sign = i % 2 == 0 ? -1.0 : 1.0;
    // Inside: outward . x <= height, x in view.
    const Vector3d outward = sign * world_from_view.rotation.row(axis).transpose();
    const double height =
        sign * ((sign < 0.0 ? box.min() : box.max())[axis] - world_from_view.translation_mm[axis]);
    Face& face = faces[static_cast<std::size_t>(i)];
    if (rays.projection() == Projection::kPerspective) {
      // outward . d <= height / depth = -height * key.
      if (height == 0.0) {
        face = {Face::Kind::kBeside, {-outward.x(), -outward.y(), -outward.z()}};
      } else {
        face = {height > 0.0 ? Face::Kind::kNotAfter : Face::Kind::kNotBefore,
                {-outward.x() / height, -outward.y() / height, -outward.z() / height}};
      }
    } else if (outward.z() == 0.0) {
      face = {Face::Kind::kBeside, {-outward.x(), -outward.y(), height}};
    } else {
      face = {outward.z() > 0.0 ? Face::Kind::kNotAfter : Face::Kind::kNotBefore,
              {-outward.x() / outward.z(), -outward.y() / outward.z(), height / outward.z()}};
    }
  }
  return faces;
}

// All that doesn't depend on the pixel.
class Caster {
 public:
  Caster(const VisualHull& hull, const ViewRays& rays, HullView* view)
      : hull_(hull), rays_(rays), view_(*view), faces_(FacesOf(hull.rig().workspace_mm, rays)) {
    const std::size_t cameras = hull.silhouettes().size();
    pencils_.resize(cameras);
    if (ExteriorIsObject(hull.rig())) sights_.resize(cameras);
    tbb::parallel_for(std::size_t{0}, cameras, [&](std::size_t i) {
      const Silhouette& silhouette = *hull.silhouettes()[i];
      const double focal_px = silhouette.plane().focal_px();
      const core::CameraModel& camera = hull.rig().cameras[i];
      pencils_[i] = std::make_unique<const EdgePencil>(silhouette.labels(), focal_px, camera, rays);
      if (!sights_.empty()) {
        sights_[i] = std::make_unique<const EdgePencil>(silhouette.plane().outline(), focal_px, camera, rays);
      }
    });
    for (const auto& silhouette : hull.silhouettes())
      view_.edges += static_cast<std::int64_t>(silhouette->labels().contour().edges.size());
  }

  void Run() {
    for (int y = 0; y < rays_.height_px(); y += kLargestSquarePx)
      for (int x = 0; x < rays_.width_px(); x += kLargestSquarePx) Divide(x, y, kLargestSquarePx);
    tbb::enumerable_thread_specific<Worker> workers;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles_.size(), kTilesATask),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        Worker& worker = workers.local();
                        for (std::size_t i = range.begin(); i < range.end(); ++i)
                          CastTileAt(tiles_[i], &worker);
                      });
    for (const Worker& worker : workers) {
      view_.hit_pixels += worker.hit_pixels;
      view_.edges_cast += worker.edges_cast;
      view_.cast_pixels += worker.cast_pixels;
    }
    view_.skipped_pixels = std::int64_t{view_.width_px} * view_.height_px - view_.cast_pixels;
  }

 private:
  struct Worker {
    Tile tile;
    std::int64_t hit_pixels = 0;
    std::int64_t cast_pixels = 0;
    std::int64_t edges_cast = 0;
  };

  // Lists the tiles of a square of pixels whose rays might meet the hull.
  void Divide(int x, int y, int size) {
    const int right = std::min(x + size, rays_.width_px()), bottom = std::min(y + size, rays_.height_px());
    const Eigen::AlignedBox2d box = rays_.BoundsOf(x, y, right, bottom);
    if (box.isEmpty() || MissesWorkspace(box) || MissesSomeContour(box)) return;
    if (size == kTilePx) {
      tiles_.emplace_back(x, y);
      return;
    }
    const int half = size / 2;
    for (const int next_y : {y, y + half})
      for (const int next_x : {x, x + half})
        if (next_x < right && next_y < bottom) Divide(next_x, next_y, half);
  }

  // True if all rays of the box pass some face on the outer side, or some pair of faces in the wrong order.
  [[nodiscard]] bool MissesWorkspace(const Eigen::AlignedBox2d& box) const {
    for (const Face& a : faces_) {
      if (a.kind == Face::Kind::kBeside && HighestOf(a.bound, box) < 0.0) return true;
      if (a.kind != Face::Kind::kNotBefore) continue;
      if (-LowestOf(a.bound, box) < 0.0 && rays_.projection() == Projection::kPerspective) return true;
      for (const Face& b : faces_) {
        if (b.kind != Face::Kind::kNotAfter) continue;
        const AffineForm gap{b.bound.du - a.bound.du, b.bound.dv - a.bound.dv,
                             b.bound.at_origin - a.bound.at_origin};
        if (HighestOf(gap, box) < 0.0) return true;
      }
    }
    return false;
  }

  static double HighestOf(const AffineForm& form, const Eigen::AlignedBox2d& box) {
    return form.at_origin + std::max(form.du * box.min().x(), form.du * box.max().x()) +
           std::max(form.dv * box.min().y(), form.dv * box.max().y());
  }
  static double LowestOf(const AffineForm& form, const Eigen::AlignedBox2d& box) {
    return -HighestOf({-form.du, -form.dv, -form.at_origin}, box);
  }

  // True if some camera's background is all that the box's rays pass.
  [[nodiscard]] bool MissesSomeContour(const Eigen::AlignedBox2d& box) const {
    for (const auto& pencil : pencils_) {
      if (!pencil->is_concentric() && !pencil->starts_inside() && !pencil->HasEdges(pencil->BinsOf(box)))
        return true;
    }
    return false;
  }

  void CastTileAt(const Eigen::Vector2i& corner, Worker* worker) {
    Tile& tile = worker->tile;
    const Vector2d centre = PlaceRays(corner, &tile);
    if (Clip(centre, &tile) == 0) return;
    const int right = std::min(corner.x() + kTilePx, rays_.width_px());
    const int bottom = std::min(corner.y() + kTilePx, rays_.height_px());
    worker->cast_pixels += (right - corner.x()) * (bottom - corner.y());
    const Eigen::AlignedBox2d box = rays_.BoundsOf(corner.x(), corner.y(), right, bottom);
    tile.cameras.resize(pencils_.size());
    tile.sights.resize(sights_.size());
    for (std::size_t i = 0; i < pencils_.size(); ++i)
      if (!Gather(*pencils_[i], corner, box, centre, &tile.cameras[i], worker)) return;
    for (std::size_t i = 0; i < sights_.size(); ++i)
      (void)Gather(*sights_[i], corner, box, centre, &tile.sights[i], worker);
    CastTile(&tile);
    Record(corner, tile, worker);
  }

  // Returns the place of the tile's centre, from which its rays count.
  Vector2d PlaceRays(const Eigen::Vector2i& corner, Tile* tile) const {
    const int right = std::min(corner.x() + kTilePx, rays_.width_px());
    const int bottom = std::min(corner.y() + kTilePx, rays_.height_px());
    const Vector2d centre = rays_.BoundsOf(corner.x(), corner.y(), right, bottom).center();
    for (int i = 0; i < kTileRays; ++i) {
      const int x = corner.x() + i % kTilePx, y = corner.y() + i / kTilePx;
      Vector2d uv = Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
      if (x < right && y < bottom) uv = rays_.At(x, y) - centre;
      tile->u[i] = static_cast<float>(uv.x());
      tile->v[i] = static_cast<float>(uv.y());
    }
    tile->key_end =
        rays_.projection() == Projection::kPerspective ? 0.0F : std::numeric_limits<float>::infinity();
    return centre;
  }

  // Where each ray is in the workspace; how many are.
  int Clip(const Vector2d& centre, Tile* tile) const {
    const bool is_perspective = rays_.projection() == Projection::kPerspective;
    int count = 0;
    for (int i = 0; i < kTileRays; ++i) {
      const Vector2d uv = centre + Vector2d(tile->u[i], tile->v[i]);
      double from = -kInfinity, to = is_perspective ? 0.0 : kInfinity;
      bool is_beside = std::isnan(tile->u[i]);
      for (const Face& face : faces_) {
        const double bound = face.bound.At(uv);
        if (face.kind == Face::Kind::kNotBefore) from = std::max(from, bound);
        if (face.kind == Face::Kind::kNotAfter) to = std::min(to, bound);
        if (face.kind == Face::Kind::kBeside) is_beside = is_beside || bound < 0.0;
      }
      const bool is_within = !is_beside && from <= to && (!is_perspective || from < 0.0);
      tile->key_from[i] = is_within ? static_cast<float>(from) : 1.0F;
      tile->key_to[i] = is_within ? static_cast<float>(to) : 0.0F;
      count += is_within ? 1 : 0;
    }
    return count;
  }

  static TileForm AboutCentre(const AffineForm& form, const Vector2d& centre) {
    return {static_cast<float>(form.du), static_cast<float>(form.dv), static_cast<float>(form.At(centre))};
  }

  // The edges that the tile's rays can meet; false if no ray of it has this camera's object before it.
  bool Gather(const EdgePencil& pencil, const Eigen::Vector2i& corner, const Eigen::AlignedBox2d& box,
              const Vector2d& centre, TileCamera* camera, Worker* worker) const {
    camera->Clear();
    if (pencil.is_concentric()) {
      for (int i = 0; i < kTileRays; ++i) {
        const int x = std::min(corner.x() + i % kTilePx, rays_.width_px() - 1);
        const int y = std::min(corner.y() + i / kTilePx, rays_.height_px() - 1);
        if (pencil.IsObjectAlong(rays_.At(x, y))) camera->starts_inside |= std::uint64_t{1} << i;
      }
      return camera->starts_inside != 0;
    }
    if (pencil.starts_inside()) camera->starts_inside = ~std::uint64_t{0};
    pencil.VisitEdges(pencil.BinsOf(box), [&](std::uint32_t index, const PencilEdge& edge) {
      (edge.enters ? camera->entries : camera->exits)
          .push_back({AboutCentre(edge.from, centre), AboutCentre(edge.to, centre),
                      AboutCentre(edge.key, centre), index});
    });
    worker->edges_cast += static_cast<std::int64_t>(camera->entries.size() + camera->exits.size());
    return camera->starts_inside != 0 || !camera->entries.empty();
  }

  void Record(const Eigen::Vector2i& corner, const Tile& tile, Worker* worker) {
    for (int i = 0; i < kTileRays; ++i) {
      const int x = corner.x() + i % kTilePx, y = corner.y() + i / kTilePx;
      // A centre in the hull has the whole picture in front of it, and nothing to see.
      if (!std::isfinite(tile.key[i]) || x >= rays_.width_px() || y >= rays_.height_px()) continue;
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(rays_.width_px()) +
                                static_cast<std::size_t>(x);
      view_.depth_mm[pixel] =
          rays_.projection() == Projection::kPerspective ? -1.0F / tile.key[i] : tile.key[i];
      view_.surface[pixel] = SurfaceOf(tile, i);
      ++worker->hit_pixels;
    }
  }

  [[nodiscard]] HullSurface SurfaceOf(const Tile& tile, int ray) const {
    if (tile.camera[ray] == Tile::kNoCamera) return {HullSurface::kWorkspace, 0};
    const auto camera = static_cast<std::size_t>(tile.camera[ray]);
    const auto entry = static_cast<std::size_t>(tile.entry[ray]);
    const std::vector<TileEdge>& entries = tile.cameras[camera].entries;
    if (entry < entries.size()) return {tile.camera[ray], entries[entry].edge};
    const auto contour_edges =
        static_cast<std::uint32_t>(hull_.silhouettes()[camera]->labels().contour().edges.size());
    return {tile.camera[ray], contour_edges + tile.sights[camera].entries[entry - entries.size()].edge};
  }

  const VisualHull& hull_;
  const ViewRays& rays_;
  HullView& view_;
  std::array<Face, 6> faces_;
  std::vector<std::unique_ptr<const EdgePencil>> pencils_;
  std::vector<std::unique_ptr<const EdgePencil>> sights_;  // of outlines
  std::vector<Eigen::Vector2i> tiles_;                     // upper left corners
};

}  // namespace

HullView ViewHull(const VisualHull& hull, const ViewRays& rays, const HullViewOptions& options) {
  HullView view;
  view.width_px = rays.width_px(), view.height_px = rays.height_px();
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  view.depth_mm.assign(pixels, 0.0F);
  view.surface.assign(pixels, {});
  view.skipped_pixels = static_cast<std::int64_t>(pixels);
  if (!hull.IsEmpty()) Caster(hull, rays, &view).Run();
  if (options.normals) view.normal_in_world = NormalsOf(hull, rays, view);
  return view;
}

HullView ViewHull(const VisualHull& hull, const core::CameraModel& view, const HullViewOptions& options) {
  return ViewHull(hull, ViewRays(view), options);
}

}  // namespace elbowroom::recon
