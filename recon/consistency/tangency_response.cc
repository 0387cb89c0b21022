#include "recon/consistency/tangency_response.h"

#include <Eigen/Geometry>
#include <cmath>

namespace elbowroom::recon {

using Eigen::Vector3d;

// With B the baseline, the two sights of one point fulfil B . (d_a x d_b) = 0, and what is computed with a
// wrong pose is -|B| rho_a rho_b (angle_a - angle_b), rho being the part of a sight across the baseline. If a
// camera is turned by v in world, its true sights are d + v x d; if it is shifted, B changes.
TangencyResponse ResponseOf(const EpipolarPairs& pairs, const Tangency& tangency) {
  const EpipolarPair& pair = pairs.pairs()[tangency.pair];
  const Tangent &a = tangency.in_a, &b = tangency.in_b;
  const double rad_per_px = std::hypot(1.0 / a.px_per_rad, 1.0 / b.px_per_rad);
  const double across_a = a.sight_in_world.cross(pair.axis).norm();
  const double across_b = b.sight_in_world.cross(pair.axis).norm();
  const double px = 1.0 / (across_a * across_b * rad_per_px);
  const Vector3d turn_a = a.sight_in_world.cross(b.sight_in_world.cross(pair.axis));
  const Vector3d turn_b = b.sight_in_world.cross(pair.axis.cross(a.sight_in_world));
  const Vector3d shift = a.sight_in_world.cross(b.sight_in_world) / pair.baseline_mm;

  TangencyResponse response;
  // A turn w in the camera's frame turns its sights in world by -R' w.
  const auto world_from = [&](core::CameraIndex camera) {
    return pairs.plane(camera).camera().cam_from_world().rotation;
  };
  response.by_pose_a << -px * (world_from(pair.a) * turn_a), -px * shift;
  response.by_pose_b << -px * (world_from(pair.b) * turn_b), px * shift;
  const double outwards = tangency.side == TangentSide::kHighest ? 1.0 : -1.0;
  response.by_dilation_a = outwards / (a.px_per_rad * rad_per_px);
  response.by_dilation_b = -outwards / (b.px_per_rad * rad_per_px);
  response.by_angle_a = 1.0 / rad_per_px;
  response.by_angle_b = -1.0 / rad_per_px;
  return response;
}

Eigen::Matrix<double, 6, 6> ShiftSquares(const core::CameraModel& camera, double focal_px,
                                         double distance_mm) {
  constexpr int kPlaces = 8;  // along each side of the picture
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (int i = 0; i < kPlaces; ++i)
    for (int j = 0; j < kPlaces; ++j) {
      const double x = ((i + 0.5) / kPlaces - 0.5) * camera.width_px() / focal_px;
      const double y = ((j + 0.5) / kPlaces - 0.5) * camera.height_px() / focal_px;
      Eigen::Matrix<double, 2, 3> by_x_in_cam;  // px, for a point of unit depth
      by_x_in_cam << 1.0, 0.0, -x, 0.0, 1.0, -y;
      by_x_in_cam *= focal_px;
      const Vector3d point(x, y, 1.0);
      Eigen::Matrix<double, 2, 6> by_pose;
      for (int axis = 0; axis < 3; ++axis)
        by_pose.col(axis) = by_x_in_cam * Vector3d::Unit(axis).cross(point);
      by_pose.rightCols<3>() = -by_x_in_cam * camera.cam_from_world().rotation / distance_mm;
      sum += by_pose.transpose() * by_pose;
    }
  return sum / (kPlaces * kPlaces);
}

}  // namespace elbowroom::recon
