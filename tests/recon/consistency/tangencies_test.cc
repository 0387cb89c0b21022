#include "recon/consistency/tangencies.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/error.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/oracles/coverage_mask.h"
#include "tests/recon/consistency/capsule_masks.h"
#include "tests/recon/consistency/hand_stage.h"
#include "tests/recon/consistency/moving_hands.h"
#include "tests/recon/consistency/true_tangents.h"

namespace elbowroom::recon::testing {
namespace {

constexpr int kFrames = 40;
constexpr double kFrameStepS = 0.37;  // frames that have little in common
constexpr double kNoisePx = 0.18;     // docs/segmentation.md measures 0.15 to 0.19

// What a parabola is off where two solids meet within its depth of 1 px.
constexpr double kWorstFitPx = 0.45;
constexpr double kRmsFitPx = 0.1;         // of one camera's tangent
constexpr double kRmsAgreementPx = 0.06;  // of two, which are off alike

double Rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}
double Worst(const std::vector<double>& values) {
  double worst = 0.0;
  for (const double value : values) worst = std::max(worst, std::abs(value));
  return worst;
}

// Each frame's tangencies, one after the other.
template <typename Visit>
void VisitFrames(const HandStage& stage, const HandMotion& motion, double noise_px, const Visit& visit) {
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::vector<Solid> solids = HandsAt(motion, kFrameStepS * frame);
    const MaskErrors errors{.noise_px = noise_px, .seed = static_cast<std::uint64_t>(frame + 1)};
    const std::vector<core::SoftMask> masks = stage.MasksOf(solids, errors);
    visit(solids, masks, FindTangencies(stage.pairs, masks));
  }
}

class EachShape : public ::testing::TestWithParam<MovingShape> {};
INSTANTIATE_TEST_SUITE_P(Tangencies, EachShape, ::testing::ValuesIn(kMovingShapes));

TEST_P(EachShape, TangentsAreThoseOfTheSolids) {
  const HandStage stage(HandRig(4));
  std::vector<double> errors_px, residuals_px;
  VisitFrames(stage, {.shape = GetParam()}, 0.0, [&](const auto& solids, const auto&, const auto& frame) {
    for (const Tangency& tangency : frame.found) {
      const EpipolarPair& pair = stage.pairs.pairs()[tangency.pair];
      const auto truth = TrueAnglesRad(pair, stage.rig.cameras[pair.a].center_in_world(), solids);
      const double true_rad = truth[static_cast<std::size_t>(tangency.side)];
      for (const Tangent* tangent : {&tangency.in_a, &tangency.in_b})
        errors_px.push_back((tangent->angle_rad - true_rad) * tangent->px_per_rad);
      residuals_px.push_back(tangency.residual_px);
    }
  });
  ASSERT_GT(residuals_px.size(), 300U);  // of 480: tongs have tips too sharp for a parabola
  EXPECT_LT(Rms(errors_px), kRmsFitPx);
  EXPECT_LT(Worst(errors_px), kWorstFitPx);
  EXPECT_LT(Rms(residuals_px), kRmsAgreementPx);
}

// No boundary point is beyond the tangent by more than the parabola is off, and one comes as near to it.
TEST_P(EachShape, TangentsAreThoseOfASearchOverAllBoundaryPoints) {
  const HandStage stage(HandRig(3));
  std::vector<double> differences_px;
  VisitFrames(stage, {.shape = GetParam()}, 0.0, [&](const auto&, const auto& masks, const auto& frame) {
    for (const Tangency& tangency : frame.found) {
      const EpipolarPair& pair = stage.pairs.pairs()[tangency.pair];
      const core::CameraModel &a = stage.rig.cameras[pair.a], &b = stage.rig.cameras[pair.b];
      const auto side = static_cast<std::size_t>(tangency.side);
      const double in_a_rad = SlowAnglesRad(a, b, pair.zero, masks[pair.a])[side];
      // Seen from b the baseline runs the other way, and so do angles about it.
      const double in_b_rad = -SlowAnglesRad(b, a, pair.zero, masks[pair.b])[1 - side];
      differences_px.push_back((tangency.in_a.angle_rad - in_a_rad) * tangency.in_a.px_per_rad);
      differences_px.push_back((tangency.in_b.angle_rad - in_b_rad) * tangency.in_b.px_per_rad);
    }
  });
  ASSERT_GT(differences_px.size(), 300U);
  EXPECT_LT(Rms(differences_px), kRmsFitPx);
  EXPECT_LT(Worst(differences_px), kWorstFitPx);
}

// The default sigma is for 0.2 px of noise that is alike over 3 px; the simulated noise is a little less.
TEST_P(EachShape, ResidualsScatterAsTheirSigmaSays) {
  constexpr double kLeast = 0.55, kMost = 1.05;
  const HandStage stage(HandRig(4));
  std::vector<double> in_sigmas;
  VisitFrames(stage, {.shape = GetParam(), .seed = 7}, kNoisePx,
              [&](const auto&, const auto&, const auto& frame) {
                for (const Tangency& tangency : frame.found)
                  in_sigmas.push_back(tangency.residual_px / tangency.sigma_px);
              });
  ASSERT_GT(in_sigmas.size(), 300U);
  EXPECT_GT(Rms(in_sigmas), kLeast);
  EXPECT_LT(Rms(in_sigmas), kMost);
  EXPECT_LT(Worst(in_sigmas), 5.0);  // one in 1e6 of normal numbers
}

// A silhouette that is dilated moves both tangents outwards: the residuals of the two sides have opposite
// signs.
TEST(Tangencies, DilationMovesBothSidesOutwards) {
  constexpr double kDilationPx = 0.4;
  const HandStage stage(HandRig(3));
  const std::vector<Solid> solids = HandsAt({.shape = MovingShape::kBumpyBall}, 1.0);
  std::vector<core::SoftMask> masks = stage.MasksOf(solids);
  const FrameTangencies before = FindTangencies(stage.pairs, masks);
  masks[0] = stage.cameras[0].MaskOf(solids, {.dilation_px = kDilationPx});
  const FrameTangencies after = FindTangencies(stage.pairs, masks);
  ASSERT_EQ(before.found.size(), 6U);
  ASSERT_EQ(after.found.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const Tangency &was = before.found[i], &is = after.found[i];
    const double moved_px = (is.in_a.angle_rad - was.in_a.angle_rad) * is.in_a.px_per_rad;
    const double outwards = is.side == TangentSide::kHighest ? 1.0 : -1.0;
    const bool is_of_first = stage.pairs.pairs()[is.pair].a == 0;
    // The parabola and the levels' steps: a tenth of what is looked for.
    EXPECT_NEAR(outwards * moved_px, is_of_first ? kDilationPx : 0.0, 0.1 * kDilationPx);
  }
}

// A forearm that goes out of the pictures hides the rest of the arm. Almost no tangency that is used then
// compares two different points.
TEST(Tangencies, ACutArmRaisesAlmostNothing) {
  constexpr std::size_t kMostWrongPercent = 1;  // the accidents that no rule excludes: docs/consistency.md
  const HandStage stage(HandRig(4));
  std::size_t used = 0, wrong = 0, skipped = 0;
  for (const MovingShape shape : {MovingShape::kOpenHand, MovingShape::kFist, MovingShape::kTwoHands}) {
    VisitFrames(stage, {.shape = shape, .seed = 3, .forearm_mm = 900.0}, 0.0,
                [&](const auto&, const auto&, const FrameTangencies& frame) {
                  used += frame.found.size();
                  skipped += frame.SkippedAll();
                  EXPECT_EQ(frame.found.size() + frame.SkippedAll(), 12U);
                  for (const Tangency& tangency : frame.found)
                    if (std::abs(tangency.residual_px) > kWorstFitPx) ++wrong;
                });
  }
  RecordProperty("used", static_cast<int>(used));
  RecordProperty("wrong", static_cast<int>(wrong));
  EXPECT_GT(used, 300U);
  EXPECT_GT(skipped, 300U);
  EXPECT_LE(100 * wrong, kMostWrongPercent * used);
}

std::size_t Skips(const FrameTangencies& frame, TangencySkip why) {
  return frame.skipped[static_cast<std::size_t>(why)];
}

// A knock, however large, is no contradiction: it shows in more than one pair of the camera.
TEST(Tangencies, AKnockedCameraIsNotContradicted) {
  const HandStage stage(HandRig(4));
  for (core::CameraIndex knocked = 0; knocked < 4; ++knocked) {
    for (const double turn_px : {4.0, 12.0, 40.0}) {
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        core::CameraCalibration calibration = stage.rig.cameras[knocked].calibration();
        const double turn_rad = turn_px / calibration.camera_matrix(0, 0);
        calibration.cam_from_world =
            core::RigidTransform{Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::Unit(axis)).toRotationMatrix(),
                                 Eigen::Vector3d::Zero()} *
            calibration.cam_from_world;
        core::Rig rig = stage.rig;
        rig.cameras[knocked] = core::CameraModel(calibration);
        const HandStage now(rig);
        double largest_px = 0.0;
        for (int frame = 0; frame < 6; ++frame) {
          const FrameTangencies found =
              FindTangencies(stage.pairs, now.MasksOf(HandsAt({}, kFrameStepS * frame)));
          EXPECT_EQ(found.skipped[static_cast<std::size_t>(TangencySkip::kContradicted)], 0U)
              << "camera " << knocked << ", " << turn_px << " px, axis " << axis;
          for (const Tangency& tangency : found.found)
            largest_px = std::max(largest_px, std::abs(tangency.residual_px));
        }
        EXPECT_GT(largest_px, 0.5 * turn_px);
      }
    }
  }
}

TEST(Tangencies, AnEmptyPictureIsNothingSeen) {
  const HandStage stage(HandRig(3));
  std::vector<core::SoftMask> masks = stage.MasksOf(HandsAt({}, 0.0));
  masks[1] = {core::BitMask(640, 480), {}};
  const FrameTangencies frame = FindTangencies(stage.pairs, masks);
  EXPECT_EQ(Skips(frame, TangencySkip::kNothingSeen), 4U);
  EXPECT_EQ(frame.found.size(), 2U);
}

TEST(Tangencies, CamerasThatLookAtEachOtherThroughTheHandHaveNone) {
  core::Rig rig = HandRig(3);
  const Eigen::Vector3d target(60.0, 0.0, 200.0);
  for (const int side : {0, 1}) {
    core::CameraCalibration facing = rig.cameras[static_cast<std::size_t>(side)].calibration();
    facing.cam_from_world =
        core::CamFromWorldLookingAt(target + Eigen::Vector3d(side == 0 ? 900.0 : -900.0, 0, 0), target);
    rig.cameras[static_cast<std::size_t>(side)] = core::CameraModel(facing);
  }
  const HandStage stage(rig);
  const std::vector<Solid> ball{
      {Sphere{60.0}, {Eigen::Matrix3d::Identity(), target}, Eigen::Vector3d::Zero()}};
  const FrameTangencies frame = FindTangencies(stage.pairs, stage.MasksOf(ball));
  EXPECT_EQ(Skips(frame, TangencySkip::kAtEpipole), 2U);
  EXPECT_EQ(frame.found.size(), 4U);
}

// Other shapes, as a perfect segmentation sees them, with the lenses and the workspace of another rig.
TEST(Tangencies, BoxesAndTubesAgreeWhereTheyAreUsed) {
  constexpr double kCornerPx = 0.6;  // a corner that a parabola still follows to three times the noise
  const core::Rig rig = FourCameraRig();
  const UndistortedPlanes planes = MakeUndistortedPlanes(rig);
  const EpipolarPairs pairs(rig, planes);
  std::size_t used = 0;
  for (int turn = 0; turn < 4; ++turn) {
    const core::RigidTransform world_from_solid = core::FromPositionAndRollPitchYaw(
        {40.0 + 15.0 * turn, -20.0 * turn, 180.0}, {20.0 + 31.0 * turn, 40.0 * turn, 17.0});
    for (const Solid& solid : {Solid{Box{{60.0, 90.0, 40.0}}, world_from_solid, Eigen::Vector3d::Zero()},
                               Solid{Tube{20.0, 18.0, 140.0}, world_from_solid, Eigen::Vector3d::Zero()}}) {
      std::vector<core::SoftMask> masks;
      for (const core::CameraModel& camera : rig.cameras)
        masks.push_back(oracles::CoverageMask(camera, {&solid, 1}));
      const FrameTangencies frame = FindTangencies(pairs, masks);
      used += frame.found.size();
      for (const Tangency& tangency : frame.found) EXPECT_LT(std::abs(tangency.residual_px), kCornerPx);
    }
  }
  EXPECT_GT(used, 20U);
}

TEST(Tangencies, OptionsOutOfRangeAreTheCallersBug) {
  const HandStage stage(HandRig(3));
  const std::vector<core::SoftMask> masks = stage.MasksOf(HandsAt({}, 0.0));
  EXPECT_THROW((void)FindTangencies(stage.pairs, masks, {.boundary_sigma_px = 0.0}), core::PreconditionError);
  EXPECT_THROW((void)FindTangencies(stage.pairs, {masks.data(), 2}), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon::testing
