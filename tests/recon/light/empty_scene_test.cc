#include "recon/light/empty_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "recon/footage/background.h"
#include "tests/recon/light/light_scene.h"

namespace elbowroom::recon {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kPictures = 60, kMinBlobPx = 200;
constexpr double kSceneNoiseLevels = 2.0, kSceneRateHz = 20.0;
constexpr TableGround kGrounds[] = {TableGround::kDarkCloth, TableGround::kGreyTable,
                                    TableGround::kPatchwork};

struct Taken {
  std::vector<TimedPicture> pictures;
  BackgroundReference reference;
};

// Sixty pictures in three seconds, as `draw` has them.
Taken Take(const std::function<DrawnPicture(double time_s)>& draw) {
  Taken taken;
  BackgroundAccumulator accumulator;
  for (int i = 0; i < kPictures; ++i) {
    const double time_s = 40.0 + i / kSceneRateHz;
    taken.pictures.push_back({draw(time_s).image_bgr, time_s});
    accumulator.Add(taken.pictures.back().image_bgr);
  }
  taken.reference = accumulator.Reference();
  return taken;
}

EmptySceneReport Examine(const Taken& taken) {
  return ExamineEmptyScene(taken.pictures, taken.reference, kMinBlobPx);
}

std::vector<std::string> FaultsIn(const Taken& taken) {
  return FaultsOf(Examine(taken), "cam2", taken.pictures.front().image_bgr.size());
}

TEST(EmptyScene, IsSteadyWhereNothingMovesUpToStrongNoise) {
  for (const TableGround ground : kGrounds) {
    for (const double noise_levels : {0.0, 0.5, 2.0, 6.0}) {
      const LightScene scene(ground, noise_levels, 3);
      const Taken taken = Take([&](double t) { return scene.At(t, {1.0, 1.0, 1.0}, false); });
      const EmptySceneReport report = Examine(taken);
      EXPECT_THAT(report.moved_px, IsEmpty()) << static_cast<int>(ground) << ", noise " << noise_levels;
      EXPECT_TRUE(report.is_light_steady()) << static_cast<int>(ground) << ", noise " << noise_levels;
      EXPECT_THAT(FaultsIn(taken), IsEmpty());
      // Rounding to whole levels adds a twelfth of a squared level.
      const double expected = std::sqrt(noise_levels * noise_levels + 1.0 / 12.0);
      constexpr double kSigmaTolerance = 0.1;  // a picture's level is also cut at black
      if (noise_levels < 0.5) continue;
      EXPECT_NEAR(report.sigma_median_levels, expected, kSigmaTolerance * expected);
    }
  }
}

TEST(EmptyScene, SaysWhereHandsMove) {
  for (const TableGround ground : kGrounds) {
    const LightScene scene(ground, kSceneNoiseLevels, 4);
    const Taken taken = Take([&](double t) { return scene.At(t, {1.0, 1.0, 1.0}, true); });
    EXPECT_FALSE(Examine(taken).moved_px.empty());
    EXPECT_FALSE(Examine(taken).pulse.has_value());  // hands may pass for one
    EXPECT_THAT(FaultsIn(taken), ElementsAre(HasSubstr("camera 'cam2': something moved")));
  }
}

TEST(EmptyScene, FindsAThingThatIsThereInOnePictureOnly) {
  const cv::Rect thing(10, 12, 40, 30);
  for (const TableGround ground : kGrounds) {
    const LightScene scene(ground, kSceneNoiseLevels, 5);
    const Taken taken = Take([&](double t) {
      return scene.At(t, {1.0, 1.0, 1.0}, false, std::abs(t - 41.0) < 1e-6 ? thing : cv::Rect());
    });
    const EmptySceneReport report = Examine(taken);
    ASSERT_FALSE(report.moved_px.empty()) << static_cast<int>(ground);
    for (const cv::Rect& box : report.moved_px) EXPECT_EQ(box & thing, box) << static_cast<int>(ground);
    EXPECT_THAT(FaultsIn(taken),
                ElementsAre("camera 'cam2': something moved in the upper left of the picture"));
  }
}

TEST(EmptyScene, LeavesOutWhatIsSmallerThanABlob) {
  const LightScene scene(TableGround::kDarkCloth, kSceneNoiseLevels, 6);
  const cv::Rect thing(100, 100, 14, 14);  // 196 px, of which its edges don't count
  const Taken taken = Take([&](double t) {
    return scene.At(t, {1.0, 1.0, 1.0}, false, t > 41.0 ? thing : cv::Rect());
  });
  EXPECT_THAT(Examine(taken).moved_px, IsEmpty());
  EXPECT_FALSE(ExamineEmptyScene(taken.pictures, taken.reference, 100).moved_px.empty());
}

TEST(EmptyScene, TellsLampsFromMovement) {
  for (const TableGround ground : kGrounds) {
    const LightScene scene(ground, kSceneNoiseLevels, 7);
    const Taken taken = Take([&](double t) {
      const double gain = 1.0 + 0.06 * std::sin(2.0 * std::numbers::pi * 103.0 * t);
      return scene.At(t, {gain, gain, gain}, false);
    });
    const EmptySceneReport report = Examine(taken);
    EXPECT_THAT(report.moved_px, IsEmpty()) << static_cast<int>(ground);
    ASSERT_TRUE(report.pulse.has_value()) << static_cast<int>(ground);
    EXPECT_NEAR(report.pulse->amplitude_share, 0.06, 0.01);
    EXPECT_NEAR(report.pulse->seen_hz, 3.0, 0.1);
    EXPECT_FALSE(report.is_light_steady());
    EXPECT_THAT(FaultsIn(taken), ElementsAre(HasSubstr("the light flickers by 6 %")));
  }
}

TEST(EmptyScene, NamesTheMainsOfTheLamps) {
  const LightScene scene(TableGround::kGreyTable, kSceneNoiseLevels, 9);
  Taken taken;
  BackgroundAccumulator accumulator;
  for (int i = 0; i < kPictures; ++i) {
    const double t = 40.0 + i / 30.0, gain = 1.0 + 0.05 * std::sin(2.0 * std::numbers::pi * 100.0 * t);
    taken.pictures.push_back({scene.At(t, {gain, gain, gain}, false).image_bgr, t});
    accumulator.Add(taken.pictures.back().image_bgr);
  }
  taken.reference = accumulator.Reference();
  EXPECT_THAT(FaultsIn(taken), ElementsAre(HasSubstr("as lamps on 50 Hz mains do")));
}

TEST(EmptyScene, TellsAutomaticExposure) {
  const LightScene scene(TableGround::kGreyTable, kSceneNoiseLevels, 8);
  const Taken taken = Take([&](double t) {
    const double gain = 1.0 + 0.04 * (t - 40.0);
    return scene.At(t, {gain, gain, gain}, false);
  });
  EXPECT_THAT(FaultsIn(taken), ElementsAre(HasSubstr("switch automatic exposure")));
}

TEST(EmptyScene, NeedsTwoPicturesAndTheirReference) {
  const LightScene scene(TableGround::kGreyTable, kSceneNoiseLevels, 8);
  const Taken taken = Take([&](double t) { return scene.At(t, {1.0, 1.0, 1.0}, false); });
  const std::span<const TimedPicture> one(taken.pictures.data(), 1), fewer(taken.pictures.data(), 30);
  EXPECT_THROW((void)ExamineEmptyScene(one, taken.reference, kMinBlobPx), core::PreconditionError);
  EXPECT_THROW((void)ExamineEmptyScene(fewer, taken.reference, kMinBlobPx), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
