#include "recon/visual_hull.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "recon/camera_query.h"

namespace elbowroom::recon {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A silhouette's edge is a staircase; its direction is taken over this many pixels.
constexpr double kEdgeSpanPx = 4.0;

bool ExteriorIsObject(const core::Rig& rig) { return rig.unseen == core::UnseenPolicy::kAbstain; }

// Distance to the nearest face from inside.
double DistanceToFace(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& x) {
  return std::min((x - box.min()).minCoeff(), (box.max() - x).minCoeff());
}

// Certified distances leave room for the rounding of the coordinates of the ball's points.
double LessRounding(double distance_mm, const Eigen::Vector3d& x) {
  return std::max(distance_mm * (1.0 - 1e-9) - 4e-15 * x.lpNorm<1>(), 0.0);
}

// What the cameras together say of a point: the inside needs all, the outside one.
class Tally {
 public:
  void Add(const CameraAnswer& answer) {
    if (answer.is_object) {
      inside_radius_mm_ = std::min(inside_radius_mm_, answer.radius_mm);
    } else {
      outside_radius_mm_ = std::max(outside_radius_mm_, answer.radius_mm);
      is_inside_ = false;
    }
    if (answer.is_seen) seen_radius_mm_ = std::max(seen_radius_mm_, answer.seen_radius_mm);
    unseen_radius_mm_ = std::min(unseen_radius_mm_, answer.unseen_radius_mm);
    any_seen_ = any_seen_ || answer.is_seen;
  }

  [[nodiscard]] PointAnswer Sum() const {
    if (!is_inside_) return {false, std::max(outside_radius_mm_, any_seen_ ? 0.0 : unseen_radius_mm_)};
    if (!any_seen_) return {false, unseen_radius_mm_};  // nobody vouches for the point
    return {true, std::min(inside_radius_mm_, seen_radius_mm_)};
  }

 private:
  bool is_inside_ = true;
  bool any_seen_ = false;
  double inside_radius_mm_ = kInfinity;
  double outside_radius_mm_ = 0.0;
  double seen_radius_mm_ = 0.0;  // the best witness's
  double unseen_radius_mm_ = kInfinity;
};

}  // namespace

VisualHull::VisualHull(std::shared_ptr<const core::Rig> rig,
                       std::vector<std::shared_ptr<const Silhouette>> silhouettes)
    : rig_(std::move(rig)), silhouettes_(std::move(silhouettes)) {
  core::Require(rig_ != nullptr && silhouettes_.size() == rig_->cameras.size(), "one silhouette a camera");
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const core::CameraModel& camera = rig_->cameras[i];
    const core::BitMask& mask = silhouettes_[i]->mask();
    if (mask.width_px() != camera.width_px() || mask.height_px() != camera.height_px()) {
      throw core::Error(
          core::ErrorKind::kCamera,
          fmt::format("camera '{}': the mask is {} x {} but the rig says {} x {}; use masks of the "
                      "calibrated size",
                      camera.name(), mask.width_px(), mask.height_px(), camera.width_px(),
                      camera.height_px()));
    }
    const bool sees_nothing = mask.CountObjectPixels() == 0;
    is_empty_ = is_empty_ || (sees_nothing && !ExteriorIsObject(*rig_));
  }
}

bool VisualHull::Contains(const Eigen::Vector3d& x_in_world) const {
  if (is_empty_ || !rig_->workspace_mm.contains(x_in_world)) return false;
  const bool exterior_is_object = ExteriorIsObject(*rig_);
  bool any_seen = !exterior_is_object;  // under `outside` an object pixel is a seen one
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const std::optional<Eigen::Vector2d> pixel = rig_->cameras[i].Project(x_in_world);
    if (!(pixel ? silhouettes_[i]->IsObject(*pixel) : exterior_is_object)) return false;
    any_seen = any_seen || (pixel && silhouettes_[i]->IsInImage(*pixel));
  }
  return any_seen;
}

PointAnswer VisualHull::Probe(const Eigen::Vector3d& x_in_world) const {
  core::CameraIndex first = 0;
  return Probe(x_in_world, kInfinity, &first);
}

PointAnswer VisualHull::Probe(const Eigen::Vector3d& x_in_world, double enough_mm,
                              core::CameraIndex* first) const {
  if (is_empty_) return {false, kInfinity};
  const bool exterior_is_object = ExteriorIsObject(*rig_);
  Tally tally;
  for (std::size_t k = 0, i = *first; k < silhouettes_.size();
       ++k, i = i + 1 < silhouettes_.size() ? i + 1 : 0) {
    const CameraAnswer answer = AskCamera(rig_->cameras[i], *silhouettes_[i], exterior_is_object, x_in_world);
    if (!answer.is_object && answer.radius_mm >= enough_mm) {
      *first = i;
      return {false, answer.radius_mm};
    }
    tally.Add(answer);
  }
  PointAnswer answer = tally.Sum();
  const Eigen::AlignedBox3d& workspace_mm = rig_->workspace_mm;
  if (!workspace_mm.contains(x_in_world)) {
    const double to_workspace_mm = LessRounding(workspace_mm.exteriorDistance(x_in_world), x_in_world);
    return {false, answer.is_inside ? to_workspace_mm : std::max(answer.radius_mm, to_workspace_mm)};
  }
  if (answer.is_inside) {
    const double to_face_mm = LessRounding(DistanceToFace(workspace_mm, x_in_world), x_in_world);
    answer.radius_mm = std::min(answer.radius_mm, to_face_mm);
  }
  return answer;
}

BallAnswer VisualHull::Classify(const Eigen::Vector3d& center_in_world, double radius_mm) const {
  if (is_empty_) return BallAnswer::kOutside;
  const Eigen::AlignedBox3d& workspace_mm = rig_->workspace_mm;
  const bool is_in_workspace = workspace_mm.contains(center_in_world);
  if (!is_in_workspace &&
      LessRounding(workspace_mm.exteriorDistance(center_in_world), center_in_world) >= radius_mm) {
    return BallAnswer::kOutside;
  }
  Tally tally;
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const CameraAnswer answer =
        AskCamera(rig_->cameras[i], *silhouettes_[i], ExteriorIsObject(*rig_), center_in_world);
    if (!answer.is_object && answer.radius_mm >= radius_mm) return BallAnswer::kOutside;
    tally.Add(answer);
  }
  const PointAnswer sum = tally.Sum();
  if (sum.radius_mm < radius_mm) return BallAnswer::kMixed;
  if (!sum.is_inside) return BallAnswer::kOutside;
  const bool keeps_inside = is_in_workspace && LessRounding(DistanceToFace(workspace_mm, center_in_world),
                                                            center_in_world) >= radius_mm;
  return keeps_inside ? BallAnswer::kInside : BallAnswer::kMixed;
}

BoundingEdge VisualHull::EdgeAt(const Eigen::Vector3d& surface_point_in_world) const {
  // The surface is where some camera is about to change its mind: the one whose label reaches least far.
  BoundingEdge edge;
  double nearest_mm = std::abs(DistanceToFace(rig_->workspace_mm, surface_point_in_world));
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const CameraAnswer answer =
        AskCamera(rig_->cameras[i], *silhouettes_[i], ExteriorIsObject(*rig_), surface_point_in_world);
    if (answer.is_seen && answer.radius_mm < nearest_mm) {
      nearest_mm = answer.radius_mm;
      edge.camera = i;
    }
  }
  if (!edge.camera) return edge;
  const core::CameraModel& camera = rig_->cameras[*edge.camera];
  const Eigen::Vector3d x_in_cam = camera.cam_from_world() * surface_point_in_world;
  const Eigen::Vector2d at = x_in_cam.head<2>() / x_in_cam.z();
  const Eigen::Vector2d outward =
      silhouettes_[*edge.camera]->OutwardDirection(camera.PixelFromNormalised(at), kEdgeSpanPx);
  if (outward.isZero()) return edge;
  // The hull's surface there is the plane through the camera's centre that cuts the picture along the edge;
  // the lens's slope takes the edge's normal from pixels to the normalised plane.
  const double step = 1e-6 * camera.max_radius();
  const auto slope_along = [&](const Eigen::Vector2d& direction) {
    return outward.dot(camera.PixelFromNormalised(at + step * direction) -
                       camera.PixelFromNormalised(at - step * direction));
  };
  const Eigen::Vector2d normal(slope_along(Eigen::Vector2d::UnitX()), slope_along(Eigen::Vector2d::UnitY()));
  const Eigen::Vector3d normal_in_cam(normal.x(), normal.y(), -normal.dot(at));
  edge.normal_in_world = camera.cam_from_world().rotation.transpose() * normal_in_cam.normalized();
  return edge;
}

VisualHull MakeVisualHull(std::shared_ptr<const core::Rig> rig, std::span<const core::BitMask> masks) {
  core::Require(rig != nullptr && masks.size() == rig->cameras.size(), "one mask a camera");
  std::vector<std::shared_ptr<const Silhouette>> silhouettes(masks.size());
  tbb::parallel_for(std::size_t{0}, masks.size(), [&](std::size_t i) {
    silhouettes[i] = std::make_shared<const Silhouette>(masks[i], ExteriorIsObject(*rig));
  });
  return {std::move(rig), std::move(silhouettes)};
}

}  // namespace elbowroom::recon
