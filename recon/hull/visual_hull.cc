#include "recon/hull/visual_hull.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/error.h"
#include "core/infinity.h"
#include "recon/contours/silhouette.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/hull/camera_query.h"
#include "recon/hull/hull_edges.h"
#include "recon/hull/next_hull.h"

namespace elbowroom::recon {
namespace {

using core::kInfinity;
// Distance to the nearest face from inside.
double DistanceToFace(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& x) {
  return std::min((x - box.min()).minCoeff(), (box.max() - x).minCoeff());
}

// Certified distances leave room for the rounding of the coordinates of the ball's points.
double LessRounding(double distance_mm, const Eigen::Vector3d& x) {
  return std::max(distance_mm * (1.0 - 1e-9) - 4e-15 * x.lpNorm<1>(), 0.0);
}

BallLabel AskSilhouette(const VisualHull& hull, std::size_t camera, const Eigen::Vector3d& x_in_world,
                        double enough_mm) {
  const Silhouette& silhouette = *hull.silhouettes()[camera];
  return AskPlane(hull.rig().cameras[camera], silhouette.plane().focal_px(), silhouette.labels(), x_in_world,
                  enough_mm);
}

// Slack for rounding where depths are compared, as a share of them.
constexpr double kDeeperSlack = 1e-8;

// The camera that is asked as the k-th: `first`, then the others as they come.
std::size_t CameraAskedAs(std::size_t k, std::size_t first) {
  if (k == 0) return first;
  return k <= first ? k - 1 : k;
}

// Under `abstain` some camera must see a point. Whether one does, and the radius of a ball around the point
// that one camera sees wholly, or that no camera sees any of.
PointAnswer SightsOf(const VisualHull& hull, const Eigen::Vector3d& x_in_world) {
  double seen_mm = 0.0, unseen_mm = kInfinity;
  bool is_seen = false;
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const UndistortedPlane& plane = hull.silhouettes()[i]->plane();
    const BallLabel sight = AskPlane(hull.rig().cameras[i], plane.focal_px(), plane.outline(), x_in_world);
    is_seen = is_seen || sight.is_object;
    if (sight.is_object) {
      seen_mm = std::max(seen_mm, sight.radius_mm);
    } else {
      unseen_mm = std::min(unseen_mm, sight.radius_mm);
    }
  }
  return is_seen ? PointAnswer{true, seen_mm} : PointAnswer{false, unseen_mm};
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
  tbb::parallel_for(std::size_t{0}, silhouettes_.size(),
                    [&](std::size_t i) { (void)silhouettes_[i]->labels(); });
  // A mask may show object only where the lens has no ray; its contour is empty then.
  const auto sees_nothing = [](const auto& silhouette) { return silhouette->labels().bounds_px().isEmpty(); };
  is_empty_ = !exterior_is_object && std::ranges::any_of(silhouettes_, sees_nothing);
}

void VisualHull::Prepare() const {
  if (is_empty_) return;
  tbb::parallel_for(std::size_t{0}, silhouettes_.size(), [&](std::size_t i) {
    (void)silhouettes_[i]->labels().CellsView();
    if (ExteriorIsObject(*rig_)) (void)silhouettes_[i]->plane().outline().CellsView();
  });
}

bool VisualHull::Contains(const Eigen::Vector3d& x_in_world) const { return Contains(x_in_world, {}); }

bool VisualHull::Contains(const Eigen::Vector3d& x_in_world, const UndecidedCameras& open) const {
  if (is_empty_ || !rig_->workspace_mm.contains(x_in_world)) return false;
  // Under `outside` a point that is object to a camera is seen by it.
  bool any_sees = !ExteriorIsObject(*rig_) || !open.asks_visibility;
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const UndistortedPlane& plane = silhouettes_[i]->plane();
    const core::CameraModel& camera = rig_->cameras[i];
    if (open.Asks(i) && !IsObjectTo(camera, plane.focal_px(), silhouettes_[i]->labels(), x_in_world))
      return false;
    any_sees = any_sees || IsObjectTo(camera, plane.focal_px(), plane.outline(), x_in_world);
  }
  return any_sees;
}

PointAnswer VisualHull::Probe(const Eigen::Vector3d& x_in_world) const {
  if (is_empty_) return {false, kInfinity};
  // A point is inside if all cameras agree, so the least radius holds. It is outside if one excludes it, so
  // the largest radius holds.
  PointAnswer answer{true, kInfinity};
  const auto add = [&answer](const PointAnswer& word) {
    if (answer.is_inside == word.is_inside) {
      answer.radius_mm = word.is_inside ? std::min(answer.radius_mm, word.radius_mm)
                                        : std::max(answer.radius_mm, word.radius_mm);
    } else if (answer.is_inside) {
      answer = word;
    }
  };
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const BallLabel label = AskSilhouette(*this, i, x_in_world, kInfinity);
    add({label.is_object, label.radius_mm});
  }
  if (ExteriorIsObject(*rig_)) add(SightsOf(*this, x_in_world));
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

bool VisualHull::MayBeDeeper(const Eigen::Vector3d& x_in_world, double radius_mm,
                             core::CameraIndex* likely) const {
  if (is_empty_) return true;
  const std::size_t first = std::min(*likely, silhouettes_.size() - 1);
  for (std::size_t k = 0; k < silhouettes_.size(); ++k) {
    const std::size_t i = CameraAskedAs(k, first);
    // Less than `radius_mm` by more than AskPlane's slack, which is a millionth of a pixel, so that the slack
    // never leads to a no.
    const double px_mm =
        (x_in_world - rig_->cameras[i].center_in_world()).norm() / silhouettes_[i]->plane().focal_px();
    const double enough_mm = radius_mm * (1.0 - kDeeperSlack) - 4e-6 * px_mm;
    if (!(enough_mm > 0.0)) return true;
    const BallLabel label = AskSilhouette(*this, i, x_in_world, enough_mm);
    if (!label.is_object) return true;
    if (label.radius_mm >= enough_mm) continue;
    *likely = i;
    return false;
  }
  return true;
}

bool VisualHull::MayHoldDeeper(const Eigen::Vector3d& center_in_world, double radius_mm, double depth_mm,
                               core::CameraIndex* likely) const {
  if (is_empty_) return false;
  // A ball of hull around a point of this one reaches `near_mm` from the centre. If that is negative, the
  // ball covers the centre, and all that is within -near_mm of it.
  const double near_mm = radius_mm - depth_mm + kDeeperSlack * (radius_mm + depth_mm);
  if (near_mm >= 0.0) {
    UndecidedCameras open;
    open.likely = *likely;
    const BallAnswer answer = Classify(center_in_world, near_mm, &open);
    if (answer == BallAnswer::kOutside) *likely = open.likely;
    return answer != BallAnswer::kOutside;
  }
  const double covered_mm = -near_mm;
  const Eigen::AlignedBox3d& workspace_mm = rig_->workspace_mm;
  if (!workspace_mm.contains(center_in_world) || DistanceToFace(workspace_mm, center_in_world) < covered_mm)
    return false;
  const std::size_t first = std::min(*likely, silhouettes_.size() - 1);
  for (std::size_t k = 0; k < silhouettes_.size(); ++k) {
    const std::size_t i = CameraAskedAs(k, first);
    const Silhouette& silhouette = *silhouettes_[i];
    if (ChangesWithinMm(rig_->cameras[i], silhouette.plane().focal_px(), silhouette.labels(),
                        center_in_world) >= covered_mm)
      continue;
    *likely = i;
    return false;
  }
  return true;
}

BallAnswer VisualHull::Classify(const Eigen::Vector3d& center_in_world, double radius_mm) const {
  UndecidedCameras open;
  return Classify(center_in_world, radius_mm, &open);
}

BallAnswer VisualHull::Classify(const Eigen::Vector3d& center_in_world, double radius_mm,
                                UndecidedCameras* open) const {
  if (is_empty_) return BallAnswer::kOutside;
  const Eigen::AlignedBox3d& workspace_mm = rig_->workspace_mm;
  const bool is_in_workspace = workspace_mm.contains(center_in_world);
  if (!is_in_workspace &&
      LessRounding(workspace_mm.exteriorDistance(center_in_world), center_in_world) >= radius_mm) {
    return BallAnswer::kOutside;
  }
  bool is_inside = is_in_workspace &&
                   LessRounding(DistanceToFace(workspace_mm, center_in_world), center_in_world) >= radius_mm;
  const std::size_t first = std::min(open->likely, silhouettes_.size() - 1);
  for (std::size_t k = 0; k < silhouettes_.size(); ++k) {
    const std::size_t i = CameraAskedAs(k, first);
    if (!open->Asks(i)) continue;
    const BallLabel label = AskSilhouette(*this, i, center_in_world, radius_mm);
    if (label.radius_mm < radius_mm) {
      is_inside = false;
    } else if (label.is_object) {
      open->Close(i);
    } else {
      open->likely = i;
      return BallAnswer::kOutside;
    }
  }
  if (ExteriorIsObject(*rig_) && open->asks_visibility) {
    const PointAnswer seen = SightsOf(*this, center_in_world);
    if (seen.radius_mm < radius_mm) {
      is_inside = false;
    } else if (seen.is_inside) {
      open->asks_visibility = false;
    } else {
      return BallAnswer::kOutside;
    }
  }
  return is_inside ? BallAnswer::kInside : BallAnswer::kMixed;
}

BallAnswer VisualHull::Classify(const WorldShape& shape, UndecidedCameras* open) const {
  if (is_empty_) return BallAnswer::kOutside;
  const Eigen::AlignedBox3d bounds = shape.Bounds();
  const Eigen::Vector3d rounding =
      Eigen::Vector3d::Constant(4e-15 * (shape.origin.lpNorm<1>() + shape.edges.lpNorm<1>()));
  const Eigen::AlignedBox3d around(bounds.min() - rounding, bounds.max() + rounding);
  if (!rig_->workspace_mm.intersects(around)) return BallAnswer::kOutside;
  bool is_inside = rig_->workspace_mm.contains(around) && !(ExteriorIsObject(*rig_) && open->asks_visibility);
  const std::size_t first = std::min(open->likely, silhouettes_.size() - 1);
  for (std::size_t k = 0; k < silhouettes_.size(); ++k) {
    const std::size_t i = CameraAskedAs(k, first);
    if (!open->Asks(i)) continue;
    const std::optional<bool> label =
        LabelOfShape(rig_->cameras[i], silhouettes_[i]->plane().focal_px(), silhouettes_[i]->labels(), shape);
    if (!label) {
      is_inside = false;
    } else if (*label) {
      open->Close(i);
    } else {
      open->likely = i;
      return BallAnswer::kOutside;
    }
  }
  return is_inside ? BallAnswer::kInside : BallAnswer::kMixed;
}

BoundingEdge VisualHull::EdgeAt(const Eigen::Vector3d& surface_point_in_world) const {
  BoundingEdge bounding;
  double nearest_mm = rig_->workspace_mm.contains(surface_point_in_world)
                          ? DistanceToFace(rig_->workspace_mm, surface_point_in_world)
                          : 0.0;
  std::optional<NearEdge> nearest;
  for (std::size_t i = 0; i < silhouettes_.size(); ++i) {
    const std::optional<NearEdge> edge = NearEdgeOf(*this, i, surface_point_in_world);
    if (!edge) continue;
    // How far the point is from the plane that the edge and the camera's centre span, about.
    const double distance_mm = edge->distance_px * edge->px_mm;
    if (distance_mm >= nearest_mm) continue;
    nearest_mm = distance_mm;
    nearest = edge;
  }
  if (nearest) {
    bounding.camera = nearest->camera;
    bounding.normal_in_world = NormalOf(*this, *nearest).in_world;
  }
  return bounding;
}

FrameHull NextHull(const std::shared_ptr<const VisualHull>& last, const std::shared_ptr<const core::Rig>& rig,
                   const UndistortedPlanes& planes, std::span<const core::SoftMask> masks) {
  return NextHull(last, rig, planes, masks, {});
}

FrameHull NextHull(const std::shared_ptr<const VisualHull>& last, const std::shared_ptr<const core::Rig>& rig,
                   const UndistortedPlanes& planes, std::span<const core::SoftMask> masks,
                   const ContourGiver& give) {
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
  if (!is_unchanged && give) give(silhouettes);
  next.hull = is_unchanged ? last : std::make_shared<const VisualHull>(rig, std::move(silhouettes));
  for (const auto& silhouette : next.hull->silhouettes())
    next.stats.untraced_silhouettes += silhouette->is_traced() ? 0 : 1;
  return next;
}

VisualHull MakeVisualHull(const std::shared_ptr<const core::Rig>& rig, const UndistortedPlanes& planes,
                          std::span<const core::SoftMask> masks) {
  return *NextHull(nullptr, rig, planes, masks).hull;
}

VisualHull MakeVisualHull(const std::shared_ptr<const core::Rig>& rig,
                          std::span<const core::SoftMask> masks) {
  core::Require(rig != nullptr, "a rig");
  const UndistortedPlanes planes = MakeUndistortedPlanes(*rig);
  return MakeVisualHull(rig, planes, masks);
}

VisualHull MakeVisualHull(const std::shared_ptr<const core::Rig>& rig, std::span<const core::BitMask> masks) {
  std::vector<core::SoftMask> soft(masks.size());
  for (std::size_t i = 0; i < masks.size(); ++i) soft[i].mask = masks[i];
  return MakeVisualHull(rig, soft);
}

}  // namespace elbowroom::recon
