#include "app/control/head/headset_poses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace elbowroom::control {
namespace {

using core::RigidTransform;

constexpr double kMmPerM = 1000.0;
// A quaternion of floats has a length of 1 to about 1e-7; of what is further off nothing is known.
constexpr double kUnitWithin = 1e-3;
// 4 degrees across at least, 76 degrees to a side at most, and the axis not far outside of the picture.
constexpr double kLeastTangents = 0.07, kMostTangent = 4.0, kLeastShare = 0.25;

RigidTransform TransformOf(const recon::WirePose& pose) {
  Eigen::Quaterniond turn(pose.quaternion_xyzw[3], pose.quaternion_xyzw[0], pose.quaternion_xyzw[1],
                          pose.quaternion_xyzw[2]);
  const bool is_turn = std::abs(turn.norm() - 1.0) < kUnitWithin;
  turn.normalize();
  return {is_turn ? turn.toRotationMatrix() : Eigen::Matrix3d::Constant(std::nan("")),
          kMmPerM * Eigen::Vector3d(pose.position_m[0], pose.position_m[1], pose.position_m[2])};
}

bool IsPicture(const recon::EyeTangents& eye) {
  const auto fits = [](double low, double high) {
    const double farthest = std::max(std::abs(low), std::abs(high));
    return high - low > std::max(kLeastTangents, kLeastShare * farthest) && farthest < kMostTangent;
  };
  return fits(eye.left, eye.right) && fits(eye.down, eye.up);
}

}  // namespace

std::optional<recon::HeadPose> HeadPoseOf(const recon::HeadsetNews& news, const HeadSettings& settings) {
  if (!std::ranges::all_of(news.eyes, IsPicture)) return std::nullopt;
  Eigen::Matrix3d tracker_from_space;
  tracker_from_space << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const RigidTransform turned{tracker_from_space, Eigen::Vector3d::Zero()};
  const RigidTransform view_from_head{Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal(), Eigen::Vector3d::Zero()};
  const RigidTransform space_from_head = TransformOf(news.space_from_view) * view_from_head;
  recon::HeadsetEyes eyes{news.pose, {}};
  for (std::size_t i = 0; i < 2; ++i) {
    const RigidTransform space_from_eye = TransformOf(news.space_from_eye[i]) * view_from_head;
    eyes.eyes[i] = {(space_from_head * settings.sensor_from_head).Inverse() * space_from_eye, news.eyes[i]};
  }
  recon::HeadPose pose;
  pose.world_from_head = settings.world_from_tracker * turned * space_from_head * settings.sensor_from_head;
  pose.measured_at = HeadClock::time_point(std::chrono::nanoseconds(news.at_ns));
  pose.source = recon::HeadSource::kOpenXr;
  pose.eyes = eyes;
  return pose;
}

}  // namespace elbowroom::control
