#include "recon/camera_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elbowroom::recon {
namespace {

// Radii shrink by this much for the rounding of their own computation ...
constexpr double kRelativeSlack = 1e-9;
// ... and by this share of the coordinates' size for theirs: of the centre, of the ball's points, on the way
// into the camera.
constexpr double kCoordinateRounding = 4e-15;
// A projected position is good to this, px.
constexpr double kPixelRoundingPx = 1e-7;
// |normalised point|, as computed, to this share.
constexpr double kNormRounding = 1e-14;

// Largest r such that every point within r of x projects, in the normalised plane, within `reach` of x's own
// projection: r |x| / (Z (Z - r)) <= reach, solved for r; always below Z.
double RadiusOfReach(const Eigen::Vector3d& x_in_cam, double reach) {
  if (std::isinf(reach)) return x_in_cam.z() * (1.0 - kRelativeSlack);
  const double z = x_in_cam.z();
  return reach * z * z / (x_in_cam.norm() + reach * z) * (1.0 - kRelativeSlack);
}

// Distance from x to the cone of all points the lens can see (half-angle atan(max_radius) about the z axis);
// negative inside it.
double DistanceToField(const Eigen::Vector3d& x_in_cam, double max_radius) {
  const double length = std::hypot(1.0, max_radius);
  const double across = x_in_cam.head<2>().norm();
  const double to_surface = (across - max_radius * x_in_cam.z()) / length;
  const double along_surface = (across * max_radius + x_in_cam.z()) / length;
  return along_surface > 0.0 ? to_surface : x_in_cam.norm();
}

double DistanceToBorder(const core::CameraModel& camera, const Eigen::Vector2d& pixel) {
  const double dx = std::min(pixel.x() + 0.5, camera.width_px() - 0.5 - pixel.x());
  const double dy = std::min(pixel.y() + 0.5, camera.height_px() - 0.5 - pixel.y());
  return std::min(dx, dy);
}

// An uncertainty in x of `rounding_mm` moves both the centre and the ball's points.
CameraAnswer Shrunk(CameraAnswer answer, double rounding_mm) {
  for (double* radius_mm : {&answer.radius_mm, &answer.seen_radius_mm, &answer.unseen_radius_mm})
    *radius_mm = std::max(*radius_mm - rounding_mm, 0.0);
  return answer;
}

// A point that the lens can't bring into any picture.
CameraAnswer AskBeyondField(const core::CameraModel& camera, const Silhouette& silhouette,
                            bool exterior_is_object, const Eigen::Vector3d& x_in_cam) {
  const double beyond_mm =
      std::max(DistanceToField(x_in_cam, camera.max_radius()), 0.0) * (1.0 - kRelativeSlack);
  CameraAnswer answer{exterior_is_object, false, beyond_mm, 0.0, beyond_mm};
  if (!(x_in_cam.z() > 0.0)) return answer;
  // Points of the field near x project near the nearest point of the domain's rim.
  const Eigen::Vector2d normalised = x_in_cam.head<2>() / x_in_cam.z();
  const Eigen::Vector2d rim = normalised * (camera.max_radius() / normalised.norm());
  if (!rim.allFinite()) return answer;
  const PixelLabel label = silhouette.LabelAt(camera.PixelFromNormalised(rim));
  if (label.is_object == exterior_is_object) {
    const double reach = label.distance_px / camera.PixelStretch(camera.max_radius());
    answer.radius_mm = std::max(answer.radius_mm, RadiusOfReach(x_in_cam, reach));
  }
  return answer;
}

}  // namespace

CameraAnswer AskCamera(const core::CameraModel& camera, const Silhouette& silhouette, bool exterior_is_object,
                       const Eigen::Vector3d& x_in_world) {
  const Eigen::Vector3d x_in_cam = camera.cam_from_world() * x_in_world;
  const double rounding_mm =
      kCoordinateRounding * (x_in_world.lpNorm<1>() + camera.cam_from_world().translation_mm.lpNorm<1>());
  const Eigen::Vector2d normalised = x_in_cam.head<2>() / x_in_cam.z();
  const double radius = normalised.norm();
  if (!(x_in_cam.z() > 0.0) || !(radius <= camera.max_radius())) {
    return Shrunk(AskBeyondField(camera, silhouette, exterior_is_object, x_in_cam), rounding_mm);
  }
  const Eigen::Vector2d pixel = camera.PixelFromNormalised(normalised);
  const PixelLabel label = silhouette.LabelAt(pixel);
  const double stretch_px = camera.PixelStretch(camera.max_radius());
  // Beyond the lens's domain everything is exterior: a different label may begin there.
  const double domain_reach = std::max(camera.max_radius() * (1.0 - kNormRounding) - radius, 0.0);
  double reach = label.distance_px / stretch_px;
  if (label.is_object != exterior_is_object) reach = std::min(reach, domain_reach);

  CameraAnswer answer;
  answer.is_object = label.is_object;
  answer.is_seen = silhouette.IsInImage(pixel);
  answer.radius_mm = RadiusOfReach(x_in_cam, reach);
  if (!exterior_is_object) {  // an object pixel is one in the picture; what else is seen doesn't matter
    answer.seen_radius_mm = answer.is_object ? answer.radius_mm : 0.0;
    return Shrunk(answer, rounding_mm);
  }
  const double border_px = DistanceToBorder(camera, pixel);
  const double border_reach = std::max(std::abs(border_px) - kPixelRoundingPx, 0.0) / stretch_px;
  (answer.is_seen ? answer.seen_radius_mm : answer.unseen_radius_mm) =
      RadiusOfReach(x_in_cam, answer.is_seen ? std::min(border_reach, domain_reach) : border_reach);
  return Shrunk(answer, rounding_mm);
}

bool IsObjectTo(const core::CameraModel& camera, const Silhouette& silhouette, bool exterior_is_object,
                const Eigen::Vector3d& x_in_world) {
  const std::optional<Eigen::Vector2d> pixel = camera.Project(x_in_world);
  return pixel ? silhouette.IsObject(*pixel) : exterior_is_object;
}

}  // namespace elbowroom::recon
