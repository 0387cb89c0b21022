// A headset's poses in the world: every sign, and the registration.
#include "app/control/head/headset_poses.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/control/head/head_pose_holder.h"

namespace elbowroom::control {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;

recon::WirePose WireOf(const Vector3d& position_m, const Quaterniond& turn) {
  return {{position_m.x(), position_m.y(), position_m.z()}, {turn.x(), turn.y(), turn.z(), turn.w()}};
}

// In OpenXR's frame; the eyes 60 mm apart.
recon::HeadsetNews NewsOf(const Vector3d& position_m, const Quaterniond& turn) {
  recon::HeadsetNews news;
  news.is_tracked = 1;
  news.pose = 7;
  news.at_ns = 123'456;
  news.space_from_view = WireOf(position_m, turn);
  for (std::size_t eye = 0; eye < 2; ++eye)
    news.space_from_eye[eye] = WireOf(position_m + turn * Vector3d(eye == 0 ? -0.03 : 0.03, 0.0, 0.0), turn);
  return news;
}

TrackerReading ReadingFor(const Quaterniond& turn) {
  return ReadingOf(HeadPoseOf(NewsOf(Vector3d::Zero(), turn), {})->world_from_head);
}

TEST(HeadsetPoses, APlaceIsToTheRightForwardAndUp) {
  const auto pose = HeadPoseOf(NewsOf({0.1, 1.2, -0.3}, Quaterniond::Identity()), {});
  ASSERT_TRUE(pose.has_value());
  // OpenXR: 0.1 m to the right, 1.2 m up, 0.3 m forward, which is -z.
  EXPECT_LT((pose->world_from_head.translation_mm - Vector3d(100.0, 300.0, 1200.0)).norm(), 1e-9);
  // Looking straight on is along the tracker's y, and the head's y is down.
  EXPECT_LT((pose->world_from_head.rotation * Vector3d::UnitZ() - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((pose->world_from_head.rotation * Vector3d::UnitY() + Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_EQ(pose->measured_at.time_since_epoch(), std::chrono::nanoseconds(123'456));
  EXPECT_EQ(pose->source, recon::HeadSource::kOpenXr);
}

TEST(HeadsetPoses, TurnsHaveTheirSigns) {
  // y is up: a turn to the right is clockwise from above, negative.
  const auto right = ReadingFor(Quaterniond(AngleAxisd(-20.0 * kDegree, Vector3d::UnitY())));
  EXPECT_NEAR(right.yaw_deg, 20.0, 1e-9);
  EXPECT_NEAR(right.pitch_deg, 0.0, 1e-9);
  // x is to the right: y goes towards z, back; what was straight on goes up.
  EXPECT_NEAR(ReadingFor(Quaterniond(AngleAxisd(15.0 * kDegree, Vector3d::UnitX()))).pitch_deg, 15.0, 1e-9);
  // z is back, towards somebody behind the head, who sees a negative turn clockwise: to the right shoulder.
  EXPECT_NEAR(ReadingFor(Quaterniond(AngleAxisd(-10.0 * kDegree, Vector3d::UnitZ()))).roll_deg, 10.0, 1e-9);
}

TEST(HeadsetPoses, TheRegistrationTakesThemToTheWorld) {
  HeadSettings settings;
  settings.world_from_tracker = core::FromPositionAndRollPitchYaw({10.0, 20.0, 30.0}, {0.0, 0.0, 90.0});
  settings.sensor_from_head.translation_mm = {0.0, 50.0, 0.0};  // the eyes are lower by 50 mm
  const auto pose = HeadPoseOf(NewsOf({0.1, 1.2, -0.3}, Quaterniond::Identity()), settings);
  ASSERT_TRUE(pose.has_value());
  EXPECT_LT(
      (pose->world_from_head.translation_mm - Vector3d(10.0 - 300.0, 20.0 + 100.0, 30.0 + 1150.0)).norm(),
      1e-9);
  // The eyes' places in the world don't depend on what is called the head.
  const auto& eyes = *pose->eyes;
  EXPECT_EQ(eyes.pose, 7);
  EXPECT_LT(((pose->world_from_head * eyes.eyes[0].head_from_eye).translation_mm -
             Vector3d(10.0 - 300.0, 20.0 + 70.0, 30.0 + 1200.0))
                .norm(),
            1e-9);
  EXPECT_GT(((pose->world_from_head * eyes.eyes[1].head_from_eye).translation_mm -
             (pose->world_from_head * eyes.eyes[0].head_from_eye).translation_mm)
                .y(),
            59.0);
}

TEST(HeadsetPoses, NonsenseIsRefused) {
  auto news = NewsOf(Vector3d::Zero(), Quaterniond::Identity());
  news.eyes[1].left = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(HeadPoseOf(news, {}).has_value());
  news.eyes[1] = {0.5, -0.5, 0.5, -0.5};
  EXPECT_FALSE(HeadPoseOf(news, {}).has_value());
  news = NewsOf(Vector3d::Zero(), Quaterniond::Identity());
  news.space_from_view.quaternion_xyzw = {0.0, 0.0, 0.0, 0.0};
  HeadPoseHolder holder;
  auto pose = *HeadPoseOf(news, {});
  pose.measured_at = HeadClock::now();
  EXPECT_EQ(holder.Offer(pose), PoseFault::kNotFinite);
  news.space_from_view.quaternion_xyzw = {0.0, 0.0, 0.0, 1.0};
  news.space_from_view.position_m[1] = std::numeric_limits<double>::infinity();
  pose = *HeadPoseOf(news, {});
  pose.measured_at = HeadClock::now();
  EXPECT_EQ(holder.Offer(pose), PoseFault::kNotFinite);
}

}  // namespace
}  // namespace elbowroom::control
