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
  void Add(const BallLabel& label) {
    if (label.is_object) {
      inside_radius_mm_ = std::min(inside_radius_mm_, label.radius_mm);
    } else {
      outside_radius_mm_ = std::max(outside_radius_mm_, label.radius_mm);
      is_inside_ = false;
    }
  }
  void AddSight(const BallLabel& seen) {
    asks_for_sight_ = true;
    if (seen.is_object) {
      any_sees_ = true;
      seen_radius_mm_ = std::max(seen_radius_mm_, seen.radius_mm);
      unseen_radius_mm_ = 0.0;
    } else {
      unseen_radius_mm_ = std::min(unseen_radius_mm_, seen.radius_mm);
    }
  }

  [[nodiscard]] PointAnswer Sum() const {
    const double nobody_mm = asks_for_sight_ ? unseen_radius_mm_ : 0.0;
    if (!is_inside_) return {false, std::max(outside_radius_mm_, nobody_mm)};
    if (!asks_for_sight_) return {true, inside_radius_mm_};
    if (!any_sees_) return {false, nobody_mm};  // nobody vouches for the point
    return {true, std::min(inside_radius_mm_, seen_radius_mm_)};
  }

 private:
  bool is_inside_ = true;
  bool asks_for_sight_ = false;
  bool any_sees_ = false;
  double inside_radius_mm_ = kInfinity;
  double outside_radius_mm_ = 0.0;
  double seen_radius_mm_ = 0.0;  // the best witness's
  double unseen_radius_mm_ = kInfinity;
};

BallLabel AskSilhouette(const VisualHull& hull, std::size_t camera, const Eigen::Vector3d& x_in_world,
                        double enough_mm) {
  const Silhouette& silhouette = *hull.silhouettes()[camera];
  return AskPlane(hull.rig().cameras[camera], silhouette.plane().focal_px(), silhouette.labels(), x_in_world,
                  enough_mm);
}

// Under `abstain` a point must be seen by someone; under `outside` an object pixel is a seen one.
void AddSights(const VisualHull& hull, const Eigen::Vector3d& x_in_world, Tally* tally) {
  if (!ExteriorIsObject(hull.rig())) return;
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const PicturePlane& plane = hull.silhouettes()[i]->plane();
    tally->AddSight(AskPlane(hull.rig().cameras[i], plane.focal_px(), plane.outline(), x_in_world));
  }
}

// Throws: core::Error{kCamera} naming the camera.
void CheckSize(const core::CameraModel& camera, const core::BitMask& mask) {
  if (mask.width_px() == camera.width_px() && mask.height_px() == camera.height_px()) return;
  throw core::Error(
      core::ErrorKind::kCamera,
      fmt::format("camera '{}': the mask is {} x {} but the rig says {} x {}; use masks of the "
                  "calibrated size",
                  camera.name(), mask.width_px(), mask.height_px(), camera.width_px(), camera.height_px()));
}

}  // namespace

bool ExteriorIsObject(const core::Rig& rig) { return rig.unseen == core::UnseenPolicy::kAbstain; }

VisualHull::VisualHull(std::shared_ptr<const core::Rig> rig,
                       std::vector<std::shared_ptr<const Silhouette>> silhouettes)
    : rig_(std::move(rig)), silhouettes_(std::move(silhouettes)) {
  core::Require(rig_ != nullptr && silhouettes_.size() == rig_->cameras.size(), "one silhouette a camera");
  const bool exterior_is_object = ExteriorIsObject(*rig_);
  for (const auto& silhouette : silhouettes_) {
    core::Require(silhouette->exterior_is_object() == exterior_is_object,
                  "silhouettes follow the rig's unseen policy");
    is_empty_ = is_empty_ || (!silhouette->shows_object() && !exterior_is_object);
  }
  if (is_empty_) return;  // no contour is needed any more
  tbb::parallel_for(std::size_t{0}, silhouettes_.size(), [&](std::size_t i) { (void)silhouettes_[i]->labels(); });
  // What a camera shows, its lens may not see.
  const auto sees_nothing = [](const auto& silhouette) { return silhouette->labels().bounds_px().isEmpty(); };
  is_empty_ = !exterior_is_object && std::ranges::any_of(silhouettes_, sees_nothing);
}

bool VisualHull::Contains(const Eigen::Vector3d& x_in_world) const {
  if (is_empty_ || !rig_->workspace_mm.contains(x_in_world)) return false;
  bool any_sees = !ExteriorIsObject(*rig_);  // under `outside` an object pixel is a seen one
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const PicturePlane& plane = silhouettes_[i]->plane();
    const core::CameraModel& camera = rig_->cameras[i];
    if (!IsObjectTo(camera, plane.focal_px(), silhouettes_[i]->labels(), x_in_world)) return false;
    any_sees = any_sees || IsObjectTo(camera, plane.focal_px(), plane.outline(), x_in_world);
  }
  return any_sees;
}

PointAnswer VisualHull::Probe(const Eigen::Vector3d& x_in_world) const {
  if (is_empty_) return {false, kInfinity};
  Tally tally;
  for (std::size_t i = 0; i < silhouettes_.size(); ++i)
    tally.Add(AskSilhouette(*this, i, x_in_world, kInfinity));
  AddSights(*this, x_in_world, &tally);
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
    const BallLabel label = AskSilhouette(*this, i, center_in_world, radius_mm);
    if (!label.is_object && label.radius_mm >= radius_mm) return BallAnswer::kOutside;
    tally.Add(label);
  }
  AddSights(*this, center_in_world, &tally);
  const PointAnswer sum = tally.Sum();
  if (sum.radius_mm < radius_mm) return BallAnswer::kMixed;
  if (!sum.is_inside) return BallAnswer::kOutside;
  const bool keeps_inside = is_in_workspace && LessRounding(DistanceToFace(workspace_mm, center_in_world),
                                                            center_in_world) >= radius_mm;
  return keeps_inside ? BallAnswer::kInside : BallAnswer::kMixed;
}

BoundingEdge VisualHull::EdgeAt(const Eigen::Vector3d& surface_point_in_world) const {
  BoundingEdge bounding;
  double nearest_mm = rig_->workspace_mm.contains(surface_point_in_world)
                          ? DistanceToFace(rig_->workspace_mm, surface_point_in_world)
                          : 0.0;
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const core::CameraModel& camera = rig_->cameras[i];
    const Eigen::Vector3d x_in_cam = camera.cam_from_world() * surface_point_in_world;
    const double focal_px = silhouettes_[i]->plane().focal_px();
    if (!(x_in_cam.z() > 0.0)) continue;
    const Eigen::Vector2d position = x_in_cam.head<2>() * (focal_px / x_in_cam.z());
    const ContourMap& labels = silhouettes_[i]->labels();
    const std::optional<std::uint32_t> edge = labels.NearestEdge(position);
    if (!edge) continue;
    // How far the point is from the plane that the edge and the camera's centre span, about.
    const double distance_mm = DistanceToEdge(labels.contour(), *edge, position) * x_in_cam.z() / focal_px;
    if (distance_mm >= nearest_mm) continue;
    nearest_mm = distance_mm;
    bounding.camera = i;
    bounding.normal_in_world =
        camera.cam_from_world().rotation.transpose() * OutwardNormalInCam(labels.contour(), *edge, focal_px);
  }
  return bounding;
}

FrameHull NextHull(const std::shared_ptr<const VisualHull>& last, const std::shared_ptr<const core::Rig>& rig,
                   const PicturePlanes& planes, std::span<const core::SoftMask> masks) {
  core::Require(rig != nullptr && masks.size() == rig->cameras.size() && planes.size() == masks.size(),
                "one mask and one plane a camera");
  core::Require(!last || last->shared_rig() == rig, "frames of one rig");
  FrameHull next;
  std::vector<std::shared_ptr<const Silhouette>> silhouettes(masks.size());
  for (std::size_t i = 0; i < masks.size(); ++i) {
    CheckSize(rig->cameras[i], masks[i].mask);
    if (last && masks[i] == last->silhouettes()[i]->soft_mask()) {
      silhouettes[i] = last->silhouettes()[i];
      ++next.stats.unchanged_silhouettes;
    } else {
      silhouettes[i] = std::make_shared<const Silhouette>(planes[i], masks[i], ExteriorIsObject(*rig));
    }
    next.stats.empty_silhouettes += silhouettes[i]->shows_object() ? 0 : 1;
  }
  const bool is_unchanged = last && next.stats.unchanged_silhouettes == std::ssize(masks);
  next.hull = is_unchanged ? last : std::make_shared<const VisualHull>(rig, std::move(silhouettes));
  for (const auto& silhouette : next.hull->silhouettes())
    next.stats.untraced_silhouettes += silhouette->is_traced() ? 0 : 1;
  return next;
}

VisualHull MakeVisualHull(std::shared_ptr<const core::Rig> rig, const PicturePlanes& planes,
                          std::span<const core::SoftMask> masks) {
  return *NextHull(nullptr, rig, planes, masks).hull;
}

VisualHull MakeVisualHull(std::shared_ptr<const core::Rig> rig, std::span<const core::SoftMask> masks) {
  core::Require(rig != nullptr, "a rig");
  const PicturePlanes planes = MakePicturePlanes(*rig);
  return MakeVisualHull(std::move(rig), planes, masks);
}

VisualHull MakeVisualHull(std::shared_ptr<const core::Rig> rig, std::span<const core::BitMask> masks) {
  std::vector<core::SoftMask> soft(masks.size());
  for (std::size_t i = 0; i < masks.size(); ++i) soft[i].mask = masks[i];
  return MakeVisualHull(std::move(rig), soft);
}

}  // namespace elbowroom::recon
