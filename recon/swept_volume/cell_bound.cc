#include "recon/swept_volume/cell_bound.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/infinity.h"
#include "recon/contours/contour_map.h"
#include "recon/contours/silhouette.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using core::kInfinity;
using Eigen::Vector2d;
using Eigen::Vector3d;

// More than a position in the plane loses to rounding, as for ball queries (recon/hull/camera_query.cc).
constexpr double kPositionSlackPx = 1e-6;
// Edges whose directions add up to less than this share of their length run both ways: a thin strip.
constexpr double kOneWayShare = 0.3;

// A cell's corners as a camera has them.
struct SeenCell {
  std::array<Vector3d, kCellCorners> corners_in_cam;
  Eigen::AlignedBox2d box_px;  // of their projections
};

// Nothing for a cell that isn't wholly in front of the camera.
std::optional<SeenCell> See(const core::CameraModel& camera, double focal_px, const CellBox& cell) {
  SeenCell seen;
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  const Vector3d low = cam_from_world * cell.low_in_world;
  const Eigen::Matrix3d sides = cam_from_world.rotation * cell.sides_mm.asDiagonal();
  for (unsigned c = 0; c < kCellCorners; ++c) {
    const Vector3d bits(c & 1U, c >> 1U & 1U, c >> 2U);
    const Vector3d x_in_cam = low + sides * bits;
    if (!(x_in_cam.z() > 0.0)) return std::nullopt;
    const Vector2d position = x_in_cam.head<2>() * (focal_px / x_in_cam.z());
    if (!position.allFinite()) return std::nullopt;
    seen.corners_in_cam[c] = x_in_cam;
    seen.box_px.extend(position);
  }
  const Vector2d slack = Vector2d::Constant(kPositionSlackPx);
  seen.box_px.extend(seen.box_px.min() - slack);
  seen.box_px.extend(seen.box_px.max() + slack);
  return seen;
}

// The corners of the polygon (or polygons) in which a contour's object meets a box: its greatest extent in
// any direction is at one of them.
struct ObjectInBox {
  std::vector<Vector2d> points;
  Vector2d outward = Vector2d::Zero();  // the edges' normals, each as long as its edge
  double edge_length_px = 0.0;
};

// The part of an edge that is in the box, if there is one.
std::optional<std::pair<Vector2d, Vector2d>> Clip(const ContourCellsView::Edge& edge,
                                                  const Eigen::AlignedBox2d& box) {
  const Vector2d from(edge.from_x, edge.from_y), step = Vector2d(edge.to_x, edge.to_y) - from;
  double first = 0.0, last = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double to_min = box.min()[axis] - from[axis], to_max = box.max()[axis] - from[axis];
    if (step[axis] == 0.0) {
      if (to_min > 0.0 || to_max < 0.0) return std::nullopt;
      continue;
    }
    const double a = to_min / step[axis], b = to_max / step[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first > last) return std::nullopt;
  return std::pair<Vector2d, Vector2d>(from + first * step, from + last * step);
}

void AddEdges(const ContourCellsView& cells, const Eigen::AlignedBox2d& box, ObjectInBox* object) {
  if (cells.width == 0 || cells.height == 0) return;
  const auto index = [&](double position, double origin, std::int32_t count) {
    return static_cast<std::int64_t>(
        std::clamp(std::floor((position - origin) * cells.cells_per_px), -1.0, static_cast<double>(count)));
  };
  const std::int64_t left = std::max<std::int64_t>(index(box.min().x(), cells.origin_x_px, cells.width), 0);
  const std::int64_t right =
      std::min<std::int64_t>(index(box.max().x(), cells.origin_x_px, cells.width), cells.width - 1);
  const std::int64_t top = std::max<std::int64_t>(index(box.min().y(), cells.origin_y_px, cells.height), 0);
  const std::int64_t bottom =
      std::min<std::int64_t>(index(box.max().y(), cells.origin_y_px, cells.height), cells.height - 1);
  for (std::int64_t y = top; y <= bottom && left <= right; ++y) {
    const auto row = static_cast<std::size_t>(y * cells.width);
    const std::size_t end = cells.first[row + static_cast<std::size_t>(right) + 1];
    for (std::size_t i = cells.first[row + static_cast<std::size_t>(left)]; i < end; ++i) {
      const auto part = Clip(cells.edges[i], box);
      if (!part) continue;
      const Vector2d along = part->second - part->first;
      object->points.push_back(part->first);
      object->points.push_back(part->second);
      object->outward += Vector2d(along.y(), -along.x());
      object->edge_length_px += along.norm();
    }
  }
}

// No points: the box is all background.
void FindObject(const ContourMap& labels, const Eigen::AlignedBox2d& box, ObjectInBox* object) {
  object->points.clear();
  object->outward.setZero();
  object->edge_length_px = 0.0;
  AddEdges(labels.CellsView(), box, object);
  for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                            Eigen::AlignedBox2d::TopLeft, Eigen::AlignedBox2d::TopRight})
    if (labels.IsObject(box.corner(corner))) object->points.push_back(box.corner(corner));
}

// The direction in which points are spread least: unit.
Vector2d NarrowDirection(const std::vector<Vector2d>& points) {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Vector2d& p : points) {
    const Vector2d off = p - mean;
    xx += off.x() * off.x(), xy += off.x() * off.y(), yy += off.y() * off.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);  // of the wide direction
  return {-std::sin(angle), std::cos(angle)};
}

// How far the corners are beyond the plane through the camera's centre that the object in the box doesn't
// pass in this direction of the picture.
CornerLimits DistancesTo(const Vector2d& direction, const ObjectInBox& object, const SeenCell& seen,
                         double focal_px) {
  double reach_px = -kInfinity;
  for (const Vector2d& p : object.points) reach_px = std::max(reach_px, direction.dot(p));
  reach_px += kPositionSlackPx;
  const double scale = 1.0 / std::hypot(focal_px, reach_px);
  CornerLimits distances;
  for (std::size_t c = 0; c < kCellCorners; ++c) {
    const Vector3d& x = seen.corners_in_cam[c];
    distances[c] = (focal_px * direction.dot(x.head<2>()) - reach_px * x.z()) * scale;
  }
  return distances;
}

// A tetrahedron with corners on both sides of the plane needs the distances themselves; one that is wholly
// inside needs values below 0; one that is wholly outside needs nothing.
CornerLimits LimitsFrom(CornerLimits distances, const BoundOptions& options) {
  unsigned inside = 0;
  for (unsigned c = 0; c < kCellCorners; ++c) {
    distances[c] -= options.rounding_mm;
    if (std::abs(distances[c]) < options.least_mm) distances[c] = -options.least_mm;
    if (distances[c] < 0.0) inside |= 1U << c;
  }
  CornerLimits limits;
  for (unsigned c = 0; c < kCellCorners; ++c) {
    const bool is_inside = (inside >> c & 1U) != 0;
    bool is_at_surface = false;
    for (unsigned other = 0; other < kCellCorners; ++other)
      is_at_surface = is_at_surface || (AreJoined(c, other) && ((inside >> other & 1U) != 0) != is_inside);
    limits[c] = is_at_surface ? distances[c] : is_inside ? -options.least_mm : kInfinity;
  }
  return limits;
}

// The limits offered that lower the values least. Equal ones: the first.
class LeastLimits {
 public:
  // Begins with those of a cell that is all hull.
  LeastLimits(const CornerLimits& values, const BoundOptions& options)
      : values_(values),
        options_(options),
        limits_(LimitsOfWholeCell(options)),
        lowered_mm_(Lowered(limits_)) {}

  void Offer(const CornerLimits& distances) {
    const CornerLimits limits = LimitsFrom(distances, options_);
    const double lowered_mm = Lowered(limits);
    if (!(lowered_mm < lowered_mm_)) return;
    lowered_mm_ = lowered_mm;
    limits_ = limits;
  }
  [[nodiscard]] const CornerLimits& limits() const { return limits_; }

 private:
  // Values above 0 say where the surface is; those below only how steeply it is passed.
  static double Weighed(double value_mm) { return value_mm > 0.0 ? value_mm : 0.05 * value_mm; }

  [[nodiscard]] double Lowered(const CornerLimits& limits) const {
    double lowered_mm = 0.0;
    for (std::size_t c = 0; c < kCellCorners; ++c)
      lowered_mm += std::max(Weighed(values_[c]) - Weighed(limits[c]), 0.0);
    return lowered_mm;
  }

  const CornerLimits& values_;
  const BoundOptions& options_;
  CornerLimits limits_;
  double lowered_mm_;
};

void OfferContour(const ObjectInBox& object, const SeenCell& seen, double focal_px, LeastLimits* least) {
  const auto offer = [&](const Vector2d& direction) {
    least->Offer(DistancesTo(direction, object, seen, focal_px));
  };
  const double outward_px = object.outward.norm();
  if (outward_px > 0.0) offer(object.outward / outward_px);
  if (outward_px > kOneWayShare * object.edge_length_px || object.points.empty()) return;
  const Vector2d narrow = NarrowDirection(object.points);
  offer(narrow);
  offer(-narrow);
}

// Faces of the workspace that the cell reaches beyond.
void OfferFaces(const Eigen::AlignedBox3d& workspace_mm, const CellBox& cell, LeastLimits* least) {
  const Vector3d high = cell.low_in_world + cell.sides_mm;
  for (int axis = 0; axis < 3; ++axis) {
    const auto offer = [&](double sign, double face_mm) {
      CornerLimits distances;
      for (unsigned c = 0; c < kCellCorners; ++c)
        distances[c] = sign * (((c >> axis & 1U) != 0 ? high : cell.low_in_world)[axis] - face_mm);
      least->Offer(distances);
    };
    if (cell.low_in_world[axis] < workspace_mm.min()[axis]) offer(-1.0, workspace_mm.min()[axis]);
    if (high[axis] > workspace_mm.max()[axis]) offer(1.0, workspace_mm.max()[axis]);
  }
}

}  // namespace

CornerLimits LimitsOfWholeCell(const BoundOptions& options) {
  CornerLimits limits;
  limits.fill(-options.least_mm);
  return limits;
}

std::optional<CornerLimits> LimitsOf(const VisualHull& hull, const CellBox& cell,
                                     const UndecidedCameras& open, const CornerLimits& values,
                                     const BoundOptions& options) {
  thread_local ObjectInBox object;
  LeastLimits least(values, options);
  OfferFaces(hull.rig().workspace_mm, cell, &least);
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    if (!open.Asks(i)) continue;
    const double focal_px = hull.silhouettes()[i]->plane().focal_px();
    const std::optional<SeenCell> seen = See(hull.rig().cameras[i], focal_px, cell);
    if (!seen) continue;
    FindObject(hull.silhouettes()[i]->labels(), seen->box_px, &object);
    if (object.points.empty()) return std::nullopt;
    OfferContour(object, *seen, focal_px, &least);
  }
  return least.limits();
}

}  // namespace elbowroom::recon
