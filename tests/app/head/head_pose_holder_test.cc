// What a head pose must be before it moves the view.
#include "app/control/head/head_pose_holder.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <random>

namespace elbowroom::control {
namespace {

using recon::HeadPose;
using std::chrono::milliseconds;

// Times that the test sets.
class Holder {
 public:
  HeadClock::time_point now{std::chrono::hours(1)};
  HeadPoseHolder holder;

  static core::RigidTransform At(double x_mm) {
    return {Eigen::Matrix3d::Identity(), Eigen::Vector3d(x_mm, -600.0, 400.0)};
  }
  std::optional<PoseFault> Offer(const core::RigidTransform& head, milliseconds age = milliseconds(5)) {
    return holder.Offer({head, now - age, recon::HeadSource::kOpenTrack, {}, {}}, now);
  }
  // Poses in a row, 10 ms apart, so that the last one is accepted.
  void Start(double x_mm = 0.0) {
    for (int i = 0; i < 3; ++i) {
      now += milliseconds(10);
      (void)Offer(At(x_mm + i));
    }
    ASSERT_FALSE(holder.StateAt(now).is_lost);
  }
  [[nodiscard]] double x_mm() const { return holder.StateAt(now).pose->world_from_head.translation_mm.x(); }
};

TEST(HeadPoseHolder, NeedsThreePosesThatAgree) {
  Holder h;
  EXPECT_TRUE(h.holder.StateAt(h.now).is_lost);
  EXPECT_EQ(h.Offer(Holder::At(0.0)), PoseFault::kUnconfirmed);
  h.now += milliseconds(10);
  EXPECT_EQ(h.Offer(Holder::At(900.0)), PoseFault::kUnconfirmed);  // another place: begins again
  h.now += milliseconds(10);
  EXPECT_EQ(h.Offer(Holder::At(901.0)), PoseFault::kUnconfirmed);
  EXPECT_FALSE(h.holder.StateAt(h.now).pose.has_value());
  h.now += milliseconds(10);
  EXPECT_EQ(h.Offer(Holder::At(902.0)), std::nullopt);
  EXPECT_EQ(h.x_mm(), 902.0);
}

TEST(HeadPoseHolder, LatestWins) {
  Holder h;
  h.Start();
  h.now += milliseconds(10);
  EXPECT_EQ(h.Offer(Holder::At(20.0)), std::nullopt);
  EXPECT_EQ(h.x_mm(), 20.0);
  EXPECT_EQ(h.Offer(Holder::At(10.0), milliseconds(8)), PoseFault::kOutOfOrder);
  EXPECT_EQ(h.Offer(Holder::At(10.0), milliseconds(5)), PoseFault::kOutOfOrder);  // a replay
  EXPECT_EQ(h.x_mm(), 20.0);
}

TEST(HeadPoseHolder, RefusesWhatIsNoPose) {
  Holder h;
  h.Start(1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  h.now += milliseconds(10);
  EXPECT_EQ(h.Offer(Holder::At(nan)), PoseFault::kNotFinite);
  EXPECT_EQ(h.Offer(Holder::At(inf)), PoseFault::kNotFinite);
  core::RigidTransform mirrored = Holder::At(0.0);
  mirrored.rotation(0, 0) = -1.0;
  EXPECT_EQ(h.Offer(mirrored), PoseFault::kNotFinite);
  EXPECT_EQ(h.Offer(Holder::At(6000.0)), PoseFault::kOutOfReach);
  EXPECT_EQ(h.Offer(Holder::At(1500.0)), PoseFault::kJump);
  core::RigidTransform turned = Holder::At(1.0);
  turned.rotation = Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_EQ(h.Offer(turned), PoseFault::kJump);
  EXPECT_EQ(h.Offer(Holder::At(2.0), milliseconds(201)), PoseFault::kStale);
  EXPECT_EQ(h.Offer(Holder::At(2.0), milliseconds(-201)), PoseFault::kStale);
  EXPECT_EQ(h.x_mm(), 3.0);
  EXPECT_EQ(h.holder.counts().all_refused(), 8 + 2);  // two unconfirmed ones at the start
}

TEST(HeadPoseHolder, KeepsThePoseWhenTrackingIsLost) {
  Holder h;
  h.Start();
  h.now += milliseconds(190);
  EXPECT_FALSE(h.holder.StateAt(h.now).is_lost);
  h.now += milliseconds(10);
  EXPECT_TRUE(h.holder.StateAt(h.now).is_lost);
  EXPECT_EQ(h.x_mm(), 2.0);
  // It comes back elsewhere, once it is confirmed.
  h.Start(1500.0);
  EXPECT_EQ(h.x_mm(), 1502.0);
}

TEST(HeadPoseHolder, DoesNotBelieveATrackerThatIsFrozen) {
  Holder h;
  h.Start();
  for (int i = 0; i < 190; ++i) {
    h.now += milliseconds(10);
    EXPECT_EQ(h.Offer(Holder::At(2.0)), std::nullopt) << i;
  }
  for (int i = 0; i < 50; ++i) {
    h.now += milliseconds(10);
    (void)h.Offer(Holder::At(2.0));
  }
  EXPECT_TRUE(h.holder.StateAt(h.now).is_lost);
  h.Start(3.0);
}

// Whatever comes, the view is where a pose that was accepted puts it, and it moves no faster than a head.
TEST(HeadPoseHolder, IsNeverMovedByDamage) {
  Holder h;
  h.Start();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> bits(-1.0, 1.0);
  double x_mm = h.x_mm();
  auto moved_at = h.now;
  for (int i = 0; i < 20'000; ++i) {
    h.now += milliseconds(1);
    core::RigidTransform pose = Holder::At(x_mm);
    const double scale = std::pow(10.0, 308.0 * bits(random));
    pose.translation_mm[static_cast<Eigen::Index>(random() % 3)] = scale * bits(random);
    if (i % 3 == 0) pose.rotation(static_cast<Eigen::Index>(random() % 3), 0) = scale;
    (void)h.Offer(pose, milliseconds(static_cast<int>(400.0 * bits(random))));
    if (i % 50 == 0) (void)h.Offer(Holder::At(x_mm), milliseconds(0));
    const HeadState state = h.holder.StateAt(h.now);
    const double now_mm = state.pose->world_from_head.translation_mm.x();
    EXPECT_TRUE(std::isfinite(now_mm));
    if (now_mm == x_mm) continue;
    EXPECT_LE(std::abs(now_mm - x_mm),
              60.0 + 5.0 * (400.0 + std::chrono::duration<double, std::milli>(h.now - moved_at).count()));
    x_mm = now_mm;
    moved_at = h.now;
  }
}

}  // namespace
}  // namespace elbowroom::control
