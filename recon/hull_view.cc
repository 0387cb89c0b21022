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

// The largest square of pixels that is asked about at once, and the one that is a piece of work.
constexpr int kLargestSquarePx = 64;
constexpr int kTaskPx = 16;
constexpr std::size_t kSquaresATask = 4;

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
    for (const Face& face : faces_) {
      (face.kind == Face::Kind::kNotBefore  ? box_.not_before
       : face.kind == Face::Kind::kNotAfter ? box_.not_after
                                            : box_.beside)
          .push_back(face.bound.Narrow());
    }
    for (const auto& silhouette : hull.silhouettes())
      view_.edges += static_cast<std::int64_t>(silhouette->labels().contour().edges.size());
  }

  void Run() {
    std::vector<Square> squares;
    for (int y = 0; y < rays_.height_px(); y += kLargestSquarePx) {
      for (int x = 0; x < rays_.width_px(); x += kLargestSquarePx)
        Divide(SquareAt(x, y, kLargestSquarePx), &squares);
    }
    tbb::enumerable_thread_specific<Worker> workers([this] {
      Worker worker;
      worker.rays.key_end =
          rays_.projection() == Projection::kPerspective ? 0.0F : std::numeric_limits<float>::infinity();
      for (const auto& pencil : pencils_)
        worker.cameras.push_back({&pencil->cast(), pencil->starts_inside() ? ~0U : 0U});
      for (const auto& pencil : sights_)
        worker.sights.push_back({&pencil->cast(), pencil->starts_inside() ? ~0U : 0U});
      return worker;
    });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, squares.size(), kSquaresATask),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        Worker& worker = workers.local();
                        for (std::size_t i = range.begin(); i < range.end(); ++i) Work(squares[i], &worker);
                      });
    for (const Worker& worker : workers) {
      view_.hit_pixels += worker.hit_pixels;
      view_.edges_met += worker.scratch.edges_met;
      view_.cast_pixels += worker.cast_pixels;
    }
    view_.skipped_pixels =
        std::max(std::int64_t{view_.width_px} * view_.height_px - view_.cast_pixels, std::int64_t{0});
  }

 private:
  struct Worker {
    TileRays rays;
    TileHits hits;
    TileScratch scratch;
    std::vector<TileCamera> cameras;
    std::vector<TileCamera> sights;
    std::int64_t hit_pixels = 0;
    std::int64_t cast_pixels = 0;
  };

  // A square of pixels, cut off at the picture's border.
  struct Square {
    int x, y, size;
    int right, bottom;
    Eigen::AlignedBox2d box;  // of its rays
  };
  [[nodiscard]] Square SquareAt(int x, int y, int size) const {
    const int right = std::min(x + size, rays_.width_px()), bottom = std::min(y + size, rays_.height_px());
    return {x, y, size, right, bottom, rays_.BoundsOf(x, y, right, bottom)};
  }

  // Lists the squares that are pieces of work and whose rays might meet the hull.
  void Divide(const Square& square, std::vector<Square>* squares) const {
    if (square.box.isEmpty() || MissesWorkspace(square.box) || MissesSomeContour(square.box)) return;
    if (square.size == kTaskPx) return squares->push_back(square);
    const int half = square.size / 2;
    for (const int y : {square.y, square.y + half})
      for (const int x : {square.x, square.x + half})
        if (x < square.right && y < square.bottom) Divide(SquareAt(x, y, half), squares);
  }

  void Work(const Square& square, Worker* worker) {
    for (int y = square.y; y < square.bottom; y += kTilePx)
      for (int x = square.x; x < square.right; x += kTilePx) CastTileAt(x, y, worker);
  }

  // True if all rays of the box pass some face on the outer side, or some pair of faces in the wrong order.
  [[nodiscard]] bool MissesWorkspace(const Eigen::AlignedBox2d& box) const {
    const bool is_perspective = rays_.projection() == Projection::kPerspective;
    for (const Face& a : faces_) {
      if (a.kind == Face::Kind::kBeside && HighestOf(a.bound, box) < 0.0) return true;
      if (a.kind != Face::Kind::kNotBefore) continue;
      if (is_perspective && LowestOf(a.bound, box) > 0.0) return true;
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
    return std::any_of(pencils_.begin(), pencils_.end(), [&](const auto& pencil) {
      return !pencil->is_concentric() && !pencil->starts_inside() && !pencil->MayEnter(box);
    });
  }

  void CastTileAt(int x, int y, Worker* worker) {
    PlaceRays(x, y, &worker->rays);
    for (std::size_t i = 0; i < pencils_.size(); ++i)
      if (pencils_[i]->is_concentric()) worker->cameras[i].starts_inside = LabelsAlong(*pencils_[i], x, y);
    CastTile(worker->rays, box_, worker->cameras, worker->sights, !view_.surface.empty(), &worker->scratch,
             &worker->hits);
    worker->cast_pixels += kTileRays;
    if (worker->hits.any) Record(x, y, worker);
  }

  [[nodiscard]] bool IsPixel(int x, int y) const { return x < rays_.width_px() && y < rays_.height_px(); }

  void PlaceRays(int x, int y, TileRays* rays) const {
    for (int i = 0; i < kTileRays; ++i) {
      const int ray_x = x + i % kTilePx, ray_y = y + i / kTilePx;
      constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
      const Vector2d uv = IsPixel(ray_x, ray_y) ? rays_.At(ray_x, ray_y) : Vector2d(kNaN, kNaN);
      rays->u[i] = static_cast<float>(uv.x());
      rays->v[i] = static_cast<float>(uv.y());
    }
  }

  // Of the tile's rays, each in its own direction from the camera's centre.
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
    const bool is_perspective = rays_.projection() == Projection::kPerspective;
    for (int i = 0; i < kTileRays; ++i) {
      // A centre in the hull has the whole picture in front of it, and nothing to see.
      if (!std::isfinite(hits.key[i])) continue;
      const std::size_t pixel =
          static_cast<std::size_t>(y + i / kTilePx) * static_cast<std::size_t>(rays_.width_px()) +
          static_cast<std::size_t>(x + i % kTilePx);
      view_.depth_mm[pixel] = is_perspective ? -1.0F / hits.key[i] : hits.key[i];
      if (!view_.surface.empty())
        view_.surface[pixel] = SurfaceOf(hits.camera[i], static_cast<std::uint32_t>(hits.edge[i]));
      ++worker->hit_pixels;
    }
  }

  [[nodiscard]] HullSurface SurfaceOf(std::int32_t number, std::uint32_t edge) const {
    if (number == TileHits::kNoCamera) return HullSurface::Workspace();
    const auto camera = static_cast<std::size_t>(number);
    if (camera < pencils_.size()) return {camera, edge};
    const std::size_t seen_by = camera - pencils_.size();
    return {seen_by,
            edge + static_cast<std::uint32_t>(hull_.silhouettes()[seen_by]->labels().contour().edges.size())};
  }

  const VisualHull& hull_;
  const ViewRays& rays_;
  HullView& view_;
  std::array<Face, 6> faces_;
  std::vector<std::unique_ptr<const EdgePencil>> pencils_;
  std::vector<std::unique_ptr<const EdgePencil>> sights_;  // of outlines
  CastBox box_;
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
  if (options.normals) view.normal_in_world = NormalsOf(hull, rays, view);
  return view;
}

HullView ViewHull(const VisualHull& hull, const core::CameraModel& view, const HullViewOptions& options) {
  return ViewHull(hull, ViewRays(view), options);
}

}  // namespace elbowroom::recon
