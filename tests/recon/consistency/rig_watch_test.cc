#include "recon/consistency/rig_watch.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/recon/consistency/capsule_masks.h"
#include "tests/recon/consistency/hand_stage.h"
#include "tests/recon/consistency/moving_hands.h"
#include "tests/recon/consistency/tangent_footage.h"
#include "tests/support/soak.h"

namespace elbowroom::recon::testing {
namespace {

using Eigen::Vector3d;

constexpr double kRateHz = 30.0;
constexpr double kKnockS = 35.0;   // after 30 blocks of learning and some seconds more
constexpr double kWithinS = 30.0;  // of hand motion, until the camera must be named
constexpr double kKnockPx = 0.3;

// Shows the watch all frames up to a time, or until it names a camera.
void Show(const TangentFootage& footage, double from_s, double to_s, RigWatch* watch) {
  const auto end = static_cast<int>(std::lround(to_s * kRateHz));
  for (auto i = static_cast<int>(std::lround(from_s * kRateHz)); i < end && !watch->state().moved; ++i)
    watch->Add(i / kRateHz, footage.FrameAt(i / kRateHz));
}

Vector3d RandomAxis(std::uint64_t seed) {
  return Vector3d(NormalFrom(seed, 101), NormalFrom(seed, 102), NormalFrom(seed, 103)).normalized();
}

TEST(RigWatch, ChiSquaredIsThatOfTheTables) {
  EXPECT_NEAR(ChiSquaredSix(0.05), 12.592, 0.001);
  EXPECT_NEAR(ChiSquaredSix(0.001), 22.458, 0.001);
}

// A residual's derivatives, against the residuals of cameras that really stand otherwise.
TEST(TangencyResponse, IsThatOfDifferences) {
  constexpr double kStepPx = 0.5;
  constexpr double kSecondOrderPx = 0.01;  // what a step of half a pixel bends
  for (const MovingShape shape : kMovingShapes) {
    TangentFootage footage(HandRig(4), {.shape = shape},
                           {.noise_px = 0.0, .slow_noise_px = 0.0, .lens_px = 0.0, .calibration_px = 0.0});
    const FrameTangencies before = footage.FrameAt(1.0);
    for (core::CameraIndex camera = 0; camera < 4; ++camera)
      for (int axis = 0; axis < 6; ++axis) {
        const Vector3d along = Vector3d::Unit(axis % 3), none = Vector3d::Zero();
        const PoseChange change =
            ChangeOfSize(*footage.pairs(), camera, axis < 3 ? along : none, axis < 3 ? none : along, kStepPx);
        footage.knocks = {{camera, 0.0, change}};
        const FrameTangencies after = footage.FrameAt(1.0);
        ASSERT_EQ(after.found.size(), before.found.size());
        for (std::size_t i = 0; i < before.found.size(); ++i) {
          const Tangency& was = before.found[i];
          const EpipolarPair& pair = footage.pairs()->pairs()[was.pair];
          const TangencyResponse response = ResponseOf(*footage.pairs(), was);
          double expected_px = 0.0;
          if (pair.a == camera) expected_px = response.by_pose_a.dot(change);
          if (pair.b == camera) expected_px = response.by_pose_b.dot(change);
          EXPECT_NEAR(after.found[i].residual_px - was.residual_px, expected_px, kSecondOrderPx)
              << NameOf(shape) << " camera " << camera << " axis " << axis;
        }
      }
  }
}

struct KnockTally {
  int trials = 0, noticed = 0, named = 0, wrong = 0;
  std::vector<double> delays_s;
  double change_squares = 0.0;  // of the found change less the true one, in sigmas
};

KnockTally KnockEachCamera(int cameras, std::uint64_t first_seed, std::uint64_t seeds) {
  KnockTally tally;
  for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed)
    for (const MovingShape shape : kMovingShapes)
      for (core::CameraIndex camera = 0; camera < static_cast<core::CameraIndex>(cameras); ++camera) {
        TangentFootage footage(HandRig(cameras), {.shape = shape, .seed = seed}, {.seed = seed});
        const Vector3d axis = RandomAxis(100 * seed + camera);
        const PoseChange change = ChangeOfSize(*footage.pairs(), camera, axis, Vector3d::Zero(), kKnockPx);
        footage.knocks = {{camera, kKnockS, change}};
        RigWatch watch(footage.pairs());
        Show(footage, 0.0, kKnockS, &watch);
        EXPECT_FALSE(watch.state().has_changed);
        double time_s = kKnockS;
        while (time_s < kKnockS + kWithinS && !watch.state().moved) {
          Show(footage, time_s, time_s + 1.0, &watch);
          time_s += 1.0;
        }
        ++tally.trials;
        if (watch.state().has_changed) ++tally.noticed;
        if (!watch.state().moved) continue;
        const CameraMoved& moved = *watch.state().moved;
        if (moved.camera != camera) {
          ++tally.wrong;
          continue;
        }
        ++tally.named;
        tally.delays_s.push_back(time_s - kKnockS);
        const PoseChange off = moved.change - change;
        tally.change_squares += off.dot(moved.covariance.ldlt().solve(off));
      }
  std::ranges::sort(tally.delays_s);
  return tally;
}

void Record(const std::string& rig, const KnockTally& tally) {
  ::testing::Test::RecordProperty(rig + "_trials", tally.trials);
  ::testing::Test::RecordProperty(rig + "_noticed", tally.noticed);
  ::testing::Test::RecordProperty(rig + "_named", tally.named);
  ::testing::Test::RecordProperty(rig + "_wrong", tally.wrong);
  if (tally.delays_s.empty()) return;
  const auto whole = [](double value) { return static_cast<int>(std::lround(value)); };
  ::testing::Test::RecordProperty(rig + "_median_s", whole(tally.delays_s[tally.delays_s.size() / 2]));
  ::testing::Test::RecordProperty(rig + "_worst_s", whole(tally.delays_s.back()));
  ::testing::Test::RecordProperty(rig + "_change_squares_percent",
                                  whole(100.0 * tally.change_squares / tally.named));
}

// The mean of the found change's error squared, in sigmas, of six numbers: 6 if the sigmas hold.
constexpr double kMostChangeSquares = 12.0;

TEST(RigWatch, NamesTheTurnedOneOfFourCameras) {
  constexpr double kLeastNamed = 0.99;
  const KnockTally tally = KnockEachCamera(4, 1, static_cast<std::uint64_t>(test_support::SoakScale()));
  Record("four", tally);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GE(tally.named, kLeastNamed * tally.trials);
  EXPECT_LT(tally.change_squares, kMostChangeSquares * tally.named);
}

TEST(RigWatch, NamesTheTurnedOneOfEightCameras) {
  const KnockTally tally =
      KnockEachCamera(8, 51, static_cast<std::uint64_t>((test_support::SoakScale() + 9) / 10));
  Record("eight", tally);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.named, tally.trials);
  EXPECT_LT(tally.change_squares, kMostChangeSquares * tally.named);
}

// If the turn moves the hands along the epipolar lines of one of its two pairs, only the other pair shows it,
// and either camera of that pair may have moved: docs/consistency.md.
TEST(RigWatch, NoticesAndMostlyNamesTheTurnedOneOfThreeCameras) {
  constexpr double kLeastNoticed = 0.97, kLeastNamed = 0.5;
  const KnockTally tally = KnockEachCamera(3, 21, static_cast<std::uint64_t>(2 * test_support::SoakScale()));
  Record("three", tally);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GE(tally.noticed, kLeastNoticed * tally.trials);
  EXPECT_GE(tally.named, kLeastNamed * tally.trials);
}

TEST(RigWatch, NamesShiftedCamerasAndHeavyKnocks) {
  struct Case {
    double px;
    bool is_shift;
  };
  for (const Case& knock : {Case{0.4, true}, Case{3.0, false}, Case{3.0, true}, Case{15.0, false}}) {
    TangentFootage footage(HandRig(4), {.shape = MovingShape::kTwoHands, .seed = 5}, {.seed = 5});
    const Vector3d axis = RandomAxis(77), none = Vector3d::Zero();
    footage.knocks = {{2, kKnockS,
                       ChangeOfSize(*footage.pairs(), 2, knock.is_shift ? none : axis,
                                    knock.is_shift ? axis : none, knock.px)}};
    RigWatch watch(footage.pairs());
    Show(footage, 0.0, kKnockS + kWithinS, &watch);
    ASSERT_TRUE(watch.state().moved) << knock.px << (knock.is_shift ? " shift" : " turn");
    EXPECT_EQ(watch.state().moved->camera, 2U);
    EXPECT_GE(watch.state().moved->since_s, kKnockS - 1.0);  // within the block of the knock, or later
    EXPECT_NEAR(watch.state().moved->shift_px, knock.px, 0.35 * knock.px + 0.1);  // "about how much"
  }
}

// Light that changes in steps, drifts and flickers, of all cameras and of each by itself, and cameras that
// are steadily late by some ms.
void ChangeLightAndClocks(TangentFootage* footage, std::uint64_t seed) {
  footage->dilation_px = [seed](core::CameraIndex camera, double time_s) {
    const auto step = static_cast<std::uint64_t>(time_s / 47.0), all = std::uint64_t{99};
    return 0.3 * NormalFrom(seed + all, step) + 0.2 * NormalFrom(seed + camera, step) +
           0.3 * std::sin(time_s / 90.0 + static_cast<double>(camera));
  };
  footage->delay_s = [seed](core::CameraIndex camera, double stamp_s) {
    return 0.004 * NormalFrom(seed + 50, camera) +
           0.002 * std::sin(stamp_s / 300.0 + static_cast<double>(camera));
  };
}

// Eight hours with twenty times as long a soak; here a twentieth.
TEST(RigWatch, NeitherLightNorFastHandsRaiseIt) {
  const double hours = 0.4 * test_support::SoakScale();
  double largest = 0.0;
  TangentFootage footage(HandRig(4), {.shape = MovingShape::kTwoHands, .seed = 31, .speed = 1.5},
                         {.seed = 31});
  ChangeLightAndClocks(&footage, 31);
  RigWatch watch(footage.pairs());
  for (double time_s = 0.0; time_s < 3600.0 * hours; time_s += 1.0) {
    Show(footage, time_s, time_s + 1.0, &watch);
    largest = std::max(largest, watch.state().largest_statistic);
  }
  RecordProperty("largest_statistic", static_cast<int>(std::lround(largest)));
  RecordProperty("threshold", static_cast<int>(std::lround(watch.state().threshold)));
  EXPECT_FALSE(watch.state().has_changed);
  EXPECT_FALSE(watch.state().moved);
}

// In the same light a knock is named all the same.
TEST(RigWatch, NamesAKnockWhileTheLightChanges) {
  for (core::CameraIndex camera = 0; camera < 4; ++camera) {
    TangentFootage footage(HandRig(4), {.shape = MovingShape::kOpenHand, .seed = 8}, {.seed = 8});
    ChangeLightAndClocks(&footage, 8);
    footage.knocks = {
        {camera, kKnockS,
         ChangeOfSize(*footage.pairs(), camera, RandomAxis(40 + camera), Vector3d::Zero(), kKnockPx)}};
    RigWatch watch(footage.pairs());
    Show(footage, 0.0, kKnockS + kWithinS, &watch);
    ASSERT_TRUE(watch.state().moved) << camera;
    EXPECT_EQ(watch.state().moved->camera, camera);
  }
}

// The whole way from masks of hands whose arms are cut by the border, which makes a few comparisons wrong.
TEST(RigWatch, NamesAKnockFromMasksOfCutArms) {
  constexpr core::CameraIndex kKnocked = 1;
  constexpr double kFromS = 14.0, kToS = 32.0;
  const core::Rig rig = HandRig(4);
  const HandStage calibrated(rig);
  const auto pairs = std::make_shared<const EpipolarPairs>(rig, calibrated.planes);
  const PoseChange change = ChangeOfSize(*pairs, kKnocked, RandomAxis(3), Vector3d::Zero(), kKnockPx);
  core::Rig knocked_rig = rig;
  core::CameraCalibration knocked = rig.cameras[kKnocked].calibration();
  const Vector3d turn_rad = change.head<3>();
  const core::RigidTransform turned_from_cam{
      Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()).toRotationMatrix(), Vector3d::Zero()};
  knocked.cam_from_world = turned_from_cam * knocked.cam_from_world;
  knocked_rig.cameras[kKnocked] = core::CameraModel(knocked);
  const HandStage after(knocked_rig);

  RigWatch watch(pairs, {.learning_blocks = 12});
  for (int i = 0; i < kToS * kRateHz && !watch.state().moved; ++i) {
    const double time_s = i / kRateHz;
    const std::vector<Solid> solids =
        HandsAt({.shape = MovingShape::kTwoHands, .seed = 3, .forearm_mm = 700.0}, time_s);
    const HandStage& stage = time_s < kFromS ? calibrated : after;
    const std::vector<core::SoftMask> masks =
        stage.MasksOf(solids, {.noise_px = 0.18, .seed = static_cast<std::uint64_t>(i + 1)});
    watch.Add(time_s, FindTangencies(*pairs, masks));
    if (time_s < kFromS) {
      EXPECT_FALSE(watch.state().has_changed);
    }
  }
  ASSERT_TRUE(watch.state().moved);
  EXPECT_EQ(watch.state().moved->camera, kKnocked);
}

// What half a minute can tell of each axis, if it alone has changed and all others are known not to.
TEST(RigWatch, HalfAMinuteBoundsEachAxis) {
  constexpr double kMostTurnSigmaPx = 0.1;  // a third of what must be named
  for (const int cameras : {3, 4, 8}) {
    TangentFootage footage(HandRig(cameras), {.shape = MovingShape::kOpenHand, .seed = 4}, {.seed = 4});
    RigWatch watch(footage.pairs());
    Show(footage, 0.0, 65.0, &watch);
    double worst_turn_px = 0.0, worst_shift_px = 0.0;
    for (core::CameraIndex camera = 0; camera < static_cast<core::CameraIndex>(cameras); ++camera) {
      const Eigen::Matrix<double, 6, 6> information = watch.Information(camera, 32);
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d in_cam = Vector3d::Unit(axis);
        const Vector3d in_world =
            footage.rig().cameras[camera].cam_from_world().rotation.transpose() * in_cam;
        const PoseChange turn = ChangeOfSize(*footage.pairs(), camera, in_cam, Vector3d::Zero(), 1.0);
        const PoseChange shift = ChangeOfSize(*footage.pairs(), camera, Vector3d::Zero(), in_world, 1.0);
        const double turn_px = 1.0 / std::sqrt(turn.dot(information * turn));
        const double shift_px = 1.0 / std::sqrt(shift.dot(information * shift));
        worst_turn_px = std::max(worst_turn_px, turn_px);
        worst_shift_px = std::max(worst_shift_px, shift_px);
        const std::string name = std::to_string(cameras) + "_" + std::to_string(camera) + "_" + "xyz"[axis];
        RecordProperty("turn_" + name + "_mpx", static_cast<int>(std::lround(1000.0 * turn_px)));
        RecordProperty("shift_" + name + "_mpx", static_cast<int>(std::lround(1000.0 * shift_px)));
      }
    }
    EXPECT_LT(worst_turn_px, kMostTurnSigmaPx) << cameras;
    EXPECT_LT(worst_shift_px, kMostTurnSigmaPx) << cameras;
  }
}

TEST(RigWatch, OptionsOutOfRangeAreTheCallersBug) {
  const TangentFootage footage(HandRig(3), {}, {});
  EXPECT_THROW(RigWatch(footage.pairs(), {.longest_window = 12}), core::PreconditionError);
  EXPECT_THROW(RigWatch(footage.pairs(), {.naming_odds = 0.5}), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon::testing
