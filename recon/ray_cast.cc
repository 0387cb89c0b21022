#include "recon/ray_cast.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr double kRefineToMm = 1e-6;
// A view's depths are float and its step a fraction of a millimetre: finer than a micrometre is lost on them.
constexpr double kViewRefinement = 256.0;
// In empty space the first camera that vouches for so many steps is enough.
constexpr double kContentSteps = 2.0;
constexpr int kTilePx = 8;
constexpr double kFar = 1e9;

struct Span {
  double from_mm;
  double to_mm;
  [[nodiscard]] bool IsEmpty() const { return !(from_mm <= to_mm); }
};

// The stretch of a ray inside a box (slab test); empty if it misses.
Span Clip(const Eigen::AlignedBox3d& box, const Ray& ray, Span span) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin_in_world[axis], direction = ray.direction_in_world[axis];
    if (direction == 0.0) {
      if (origin < box.min()[axis] || origin > box.max()[axis]) return {1.0, 0.0};
      continue;
    }
    const auto [near, far] =
        std::minmax({(box.min()[axis] - origin) / direction, (box.max()[axis] - origin) / direction});
    span.from_mm = std::max(span.from_mm, near);
    span.to_mm = std::min(span.to_mm, far);
  }
  return span;
}

Eigen::Vector3d PointAt(const Ray& ray, double t_mm) {
  return ray.origin_in_world + t_mm * ray.direction_in_world;
}

struct March {
  double step_mm;    // where no larger one is certain
  double refine_mm;  // the crossing is bisected to this
  bool wanted;       // what Contains() says where the march ends
};

std::optional<double> Run(const March& march, const VisualHull& hull, const Ray& ray, Span span,
                          std::int64_t* probes) {
  core::CameraIndex first = 0;
  double not_yet_mm = span.from_mm;  // all before this is certain to be unwanted
  for (double t_mm = span.from_mm; t_mm <= span.to_mm;) {
    const PointAnswer answer = hull.Probe(PointAt(ray, t_mm), kContentSteps * march.step_mm, &first);
    ++*probes;
    if (answer.is_inside == march.wanted) {
      double found_mm = t_mm;
      while (found_mm - not_yet_mm > march.refine_mm) {
        const double middle_mm = 0.5 * (not_yet_mm + found_mm);
        if (middle_mm <= not_yet_mm || middle_mm >= found_mm) break;
        (hull.Contains(PointAt(ray, middle_mm)) == march.wanted ? found_mm : not_yet_mm) = middle_mm;
      }
      return found_mm;
    }
    if (t_mm == span.to_mm) break;
    not_yet_mm = t_mm + answer.radius_mm;
    t_mm = std::min(t_mm + std::max(answer.radius_mm, march.step_mm), span.to_mm);
  }
  return std::nullopt;
}

// A view camera's rays, in the world.
class ViewRays {
 public:
  explicit ViewRays(const core::CameraModel& view)
      : view_(view), world_from_cam_(view.cam_from_world().Inverse()) {}

  [[nodiscard]] std::optional<Eigen::Vector3d> DirectionInCam(double x_px, double y_px) const {
    const std::optional<Eigen::Vector2d> normalised = view_.NormalisedFromPixel({x_px, y_px});
    if (!normalised) return std::nullopt;
    return normalised->homogeneous().normalized();
  }
  [[nodiscard]] Ray InWorld(const Eigen::Vector3d& direction_in_cam) const {
    return {view_.center_in_world(), world_from_cam_.rotation * direction_in_cam};
  }

 private:
  const core::CameraModel& view_;
  core::RigidTransform world_from_cam_;
};

// How far a whole bundle of rays from one centre can go before any of them may meet the hull; nothing if they
// all leave the workspace. `spread`: largest |direction - axis direction| in the bundle. Near the hull, where
// certain steps shrink below `step_mm`, the beam leaves the rest to its rays.
std::optional<double> MarchBeam(const VisualHull& hull, const Ray& axis, double spread, double box_margin_mm,
                                double step_mm, std::int64_t* probes) {
  Eigen::AlignedBox3d box = hull.rig().workspace_mm;
  // A ray of the bundle may be in the workspace where the axis isn't, by at most its distance from the axis.
  box.min().array() -= box_margin_mm;
  box.max().array() += box_margin_mm;
  const Span span = Clip(box, axis, {0.0, kFar});
  if (span.IsEmpty()) return std::nullopt;
  double t_mm = span.from_mm;
  while (t_mm <= span.to_mm) {
    const PointAnswer answer = hull.Probe(PointAt(axis, t_mm));
    ++*probes;
    // At distance t + s along its own ray a bundle point is at most s + (t + s) spread from the axis point at
    // t.
    const double advance_mm = answer.is_inside ? 0.0 : (answer.radius_mm - t_mm * spread) / (1.0 + spread);
    if (advance_mm < std::max(0.5 * t_mm * spread, step_mm)) return t_mm;
    t_mm += advance_mm;
  }
  return std::nullopt;
}

struct TileBeam {
  Ray axis;
  double spread = 0.0;
};

// Nothing where the lens has no ray for a corner: such a tile's rays go alone.
std::optional<TileBeam> BeamOf(const ViewRays& rays, int x0, int y0, int x1, int y1) {
  const auto axis = rays.DirectionInCam(0.5 * (x0 + x1 - 1), 0.5 * (y0 + y1 - 1));
  if (!axis) return std::nullopt;
  TileBeam beam{rays.InWorld(*axis), 0.0};
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      if (x != x0 && x != x1 - 1 && y != y0 && y != y1 - 1) continue;
      const auto direction = rays.DirectionInCam(x, y);
      if (!direction) return std::nullopt;
      beam.spread = std::max(beam.spread, (*direction - *axis).norm());
    }
  }
  beam.spread *= 1.0 + 1e-6;
  return beam;
}

struct TileCount {
  std::int64_t hits = 0, probes = 0, skipped = 0;
};

// Draws one tile of a view; tiles share nothing but the picture they write to.
class TilePainter {
 public:
  TilePainter(const VisualHull& hull, const core::CameraModel& view, double step_mm, HullView* picture)
      : hull_(hull),
        rays_(view),
        step_mm_(step_mm),
        farthest_mm_(hull.rig().workspace_mm.exteriorDistance(view.center_in_world()) +
                     hull.rig().workspace_mm.diagonal().norm()),
        picture_(picture) {}

  [[nodiscard]] TileCount Paint(int x0, int y0) const {
    TileCount count;
    const int x1 = std::min(x0 + kTilePx, picture_->width_px),
              y1 = std::min(y0 + kTilePx, picture_->height_px);
    double start_mm = 0.0;
    if (const std::optional<TileBeam> beam = BeamOf(rays_, x0, y0, x1, y1)) {
      const auto start =
          MarchBeam(hull_, beam->axis, beam->spread, farthest_mm_ * beam->spread, step_mm_, &count.probes);
      if (!start) {
        count.skipped = std::int64_t{x1 - x0} * (y1 - y0);
        return count;
      }
      start_mm = *start;
    }
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) PaintPixel(x, y, start_mm, &count);
    }
    return count;
  }

 private:
  void PaintPixel(int x, int y, double start_mm, TileCount* count) const {
    const std::optional<Eigen::Vector3d> direction_in_cam = rays_.DirectionInCam(x, y);
    if (!direction_in_cam) return;
    const Ray ray = rays_.InWorld(*direction_in_cam);
    const Span span = Clip(hull_.rig().workspace_mm, ray, {start_mm, kFar});
    if (span.IsEmpty()) return;
    const std::optional<double> hit_mm =
        Run({step_mm_, step_mm_ / kViewRefinement, true}, hull_, ray, span, &count->probes);
    if (!hit_mm || *hit_mm == 0.0) return;  // from inside the hull there is no surface to see first
    const BoundingEdge edge = hull_.EdgeAt(PointAt(ray, *hit_mm));
    const Eigen::Vector3d normal = edge.normal_in_world.value_or(-ray.direction_in_world);
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_->width_px) +
                       static_cast<std::size_t>(x);
    picture_->depth_mm[pixel] = static_cast<float>(*hit_mm * direction_in_cam->z());
    picture_->normal_in_world[pixel] = normal.cast<float>();
    ++count->hits;
  }

  const VisualHull& hull_;
  ViewRays rays_;
  double step_mm_;
  double farthest_mm_;
  HullView* picture_;
};

}  // namespace

std::optional<double> FirstInside(const VisualHull& hull, const Ray& ray, const RayOptions& options) {
  core::Require(options.step_mm > 0.0, "a ray's step is positive");
  const Span span = Clip(hull.rig().workspace_mm, ray, {options.from_mm, options.to_mm});
  if (hull.IsEmpty() || span.IsEmpty()) return std::nullopt;
  std::int64_t probes = 0;
  return Run({options.step_mm, kRefineToMm, true}, hull, ray, span, &probes);
}

std::optional<double> FirstOutside(const VisualHull& hull, const Ray& ray, const RayOptions& options) {
  core::Require(options.step_mm > 0.0, "a ray's step is positive");
  std::int64_t probes = 0;
  return Run({options.step_mm, kRefineToMm, false}, hull, ray, {options.from_mm, options.to_mm}, &probes);
}

HullView ViewHull(const VisualHull& hull, const core::CameraModel& view, double step_mm) {
  core::Require(step_mm > 0.0, "a view's step is positive");
  HullView result;
  result.width_px = view.width_px();
  result.height_px = view.height_px();
  const auto pixels = static_cast<std::size_t>(result.width_px) * static_cast<std::size_t>(result.height_px);
  result.depth_mm.assign(pixels, 0.0F);
  result.normal_in_world.assign(pixels, Eigen::Vector3f::Zero());
  if (hull.IsEmpty()) {
    result.skipped_pixels = static_cast<std::int64_t>(pixels);
    return result;
  }
  const TilePainter painter(hull, view, step_mm, &result);
  const int tiles_x = (result.width_px + kTilePx - 1) / kTilePx,
            tiles_y = (result.height_px + kTilePx - 1) / kTilePx;
  std::atomic<std::int64_t> hits = 0, probes = 0, skipped = 0;
  tbb::parallel_for(0, tiles_x * tiles_y, [&](int tile) {
    const TileCount count = painter.Paint(tile % tiles_x * kTilePx, tile / tiles_x * kTilePx);
    hits += count.hits;
    probes += count.probes;
    skipped += count.skipped;
  });
  result.hit_pixels = hits;
  result.probes = probes;
  result.skipped_pixels = skipped;
  return result;
}

}  // namespace elbowroom::recon
