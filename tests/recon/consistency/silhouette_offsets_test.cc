#include "recon/consistency/silhouette_offsets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/recon/consistency/capsule_masks.h"
#include "tests/recon/consistency/hand_stage.h"
#include "tests/recon/consistency/offset_tally.h"
#include "tests/recon/consistency/tangent_footage.h"
#include "tests/support/soak.h"

namespace elbowroom::recon::testing {
namespace {

constexpr double kFilmRateHz = 30.0;
constexpr double kFootageS = 30.0;
constexpr double kMostErrorS = 0.003;  // what is promised for half a minute of moving hands

// When camera i takes its picture k, by its stamp: it runs freely, and its stamps jitter a little.
double StampOf(std::uint64_t seed, core::CameraIndex camera, int picture) {
  const double phase_s = 0.0077 * static_cast<double>(camera) + 0.01;
  return phase_s + picture / kFilmRateHz +
         5e-4 * NormalFrom(seed + camera, 10'000 + static_cast<std::uint64_t>(picture));
}
bool IsDropped(std::uint64_t seed, core::CameraIndex camera, int picture) {
  return NormalFrom(seed + 31 * camera, 90'000 + static_cast<std::uint64_t>(picture)) > 2.3;  // 1 %
}

// Offsets up to about a frame period and a half; that of the first camera is 0.
std::vector<double> DrawOffsets(std::uint64_t seed, std::size_t cameras) {
  std::vector<double> offsets_s{0.0};
  while (offsets_s.size() < cameras)
    offsets_s.push_back(std::clamp(0.022 * NormalFrom(seed, 500 + offsets_s.size()), -0.05, 0.05));
  return offsets_s;
}

using Footage = std::vector<std::vector<StampedTangents>>;

Footage Film(TangentFootage* scene, std::uint64_t seed, const std::vector<double>& offsets_s,
             double seconds) {
  // What the stamps say is off by a fifth of a millisecond, each by itself.
  scene->delay_s = [seed, offsets_s](core::CameraIndex camera, double stamp_s) {
    const auto number = static_cast<std::uint64_t>(std::llround(stamp_s * 1e6));
    return offsets_s[camera] + 2e-4 * NormalFrom(seed + 77 + camera, number);
  };
  Footage footage(offsets_s.size());
  for (core::CameraIndex camera = 0; camera < offsets_s.size(); ++camera)
    for (int picture = 0; picture < seconds * kFilmRateHz; ++picture) {
      if (IsDropped(seed, camera, picture)) continue;
      const double stamp_s = StampOf(seed, camera, picture);
      footage[camera].push_back({stamp_s, scene->TangentsOf(camera, stamp_s)});
    }
  return footage;
}

OffsetTally FindMany(int cameras, double speed, std::uint64_t seeds) {
  OffsetTally tally;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed)
    for (const MovingShape shape : kMovingShapes) {
      TangentFootage scene(HandRig(cameras), {.shape = shape, .seed = seed, .speed = speed}, {.seed = seed});
      const std::vector<double> truth_s = DrawOffsets(seed, static_cast<std::size_t>(cameras));
      const auto found = FindSilhouetteOffsets(*scene.pairs(), Film(&scene, seed, truth_s, kFootageS));
      EXPECT_TRUE(found) << NameOf(shape) << " seed " << seed;
      if (!found) continue;
      for (std::size_t i = 1; i < truth_s.size(); ++i)
        EXPECT_LT(std::abs(found->offset_s[i] - truth_s[i]), kMostErrorS)
            << NameOf(shape) << " seed " << seed << " camera " << i;
      tally.Add(found->offset_s, found->sigma_s, found->covariance_s2, truth_s);
    }
  return tally;
}

// 68 and 95 % of a normal number; of about 60 trials that aren't independent, so the bounds are wide.
void ExpectSigmasHold(const OffsetTally& tally) {
  const auto count = static_cast<double>(tally.errors_s.size());
  EXPECT_GT(tally.within_1, 0.52 * count);
  EXPECT_LT(tally.within_1, 0.9 * count);
  EXPECT_GT(tally.within_2, 0.85 * count);
  EXPECT_LT(tally.squares, 1.8 * count);
  EXPECT_GT(tally.squares, 0.4 * count);
}

TEST(SilhouetteOffsets, AreFoundToATenthOfAMillisecondAtWorkingSpeed) {
  const OffsetTally tally = FindMany(4, 1.0, static_cast<std::uint64_t>(4 * test_support::SoakScale()));
  tally.Record("four");
  ExpectSigmasHold(tally);
  EXPECT_LT(*std::ranges::max_element(tally.errors_s), 0.001);
}

TEST(SilhouetteOffsets, AreFoundByThreeCameras) {
  const OffsetTally tally = FindMany(3, 1.0, static_cast<std::uint64_t>(4 * test_support::SoakScale()));
  tally.Record("three");
  ExpectSigmasHold(tally);
}

// A third of the speed: three times the error, and few movements to judge it by.
TEST(SilhouetteOffsets, AreFoundFromSlowHands) {
  const OffsetTally tally = FindMany(4, 0.3, static_cast<std::uint64_t>(4 * test_support::SoakScale()));
  tally.Record("slow");
  ExpectSigmasHold(tally);
}

TEST(SilhouetteOffsets, AreFoundByEightCamerasAndBeyondTwoPeriods) {
  TangentFootage scene(HandRig(8), {.shape = MovingShape::kOpenHand, .seed = 2}, {.seed = 2});
  std::vector<double> truth_s{0.0, 0.02, -0.03, 0.075, -0.01, 0.033, -0.015, 0.0};
  const auto found =
      FindSilhouetteOffsets(*scene.pairs(), Film(&scene, 2, truth_s, kFootageS), {.search_s = 0.12});
  ASSERT_TRUE(found);
  for (std::size_t i = 1; i < truth_s.size(); ++i)
    EXPECT_NEAR(found->offset_s[i], truth_s[i], 5.0 * found->sigma_s[i]);
}

// The whole way from masks, with arms that the border cuts.
TEST(SilhouetteOffsets, AreFoundFromMasksOfCutArms) {
  constexpr double kSeconds = 16.0;
  const HandStage stage(HandRig(4));
  const HandMotion motion{.shape = MovingShape::kOpenHand, .seed = 6, .forearm_mm = 700.0};
  const std::vector<double> truth_s{0.0, 0.021, -0.017, 0.03};
  Footage footage(4);
  for (core::CameraIndex camera = 0; camera < 4; ++camera)
    for (int picture = 0; picture < kSeconds * kFilmRateHz; ++picture) {
      const double stamp_s = StampOf(6, camera, picture);
      const std::vector<Solid> solids = HandsAt(motion, 1.0 + stamp_s + truth_s[camera]);
      const core::SoftMask mask = stage.cameras[camera].MaskOf(
          solids, {.noise_px = 0.18, .seed = camera * 100'000 + static_cast<std::uint64_t>(picture)});
      footage[camera].push_back({stamp_s, FindTangents(stage.pairs, camera, mask)});
    }
  const auto found = FindSilhouetteOffsets(stage.pairs, footage);
  ASSERT_TRUE(found);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_NEAR(found->offset_s[i], truth_s[i], kMostErrorS);
    EXPECT_NEAR(found->offset_s[i], truth_s[i], 5.0 * found->sigma_s[i]);
  }
}

TEST(SilhouetteOffsets, StillHandsAndShortFootageTellNothing) {
  const std::vector<double> truth_s{0.0, 0.01, 0.02};
  TangentFootage still(HandRig(3), {.speed = 0.0}, {});
  EXPECT_FALSE(FindSilhouetteOffsets(*still.pairs(), Film(&still, 1, truth_s, kFootageS)));
  TangentFootage brief(HandRig(3), {}, {});
  EXPECT_FALSE(FindSilhouetteOffsets(*brief.pairs(), Film(&brief, 1, truth_s, 3.0)));
  EXPECT_THROW((void)FindSilhouetteOffsets(*brief.pairs(), Footage(2)), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon::testing
