// How wrong silhouettes become when the light changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/recon/segmentation/lit_scenes.h"

namespace elbowroom::recon {
namespace {

constexpr double kSensorNoiseLevels = 5.1;  // 2 % of 255, as the paper's cameras
constexpr int kLitFrames = 4;

std::vector<Segmenter> SegmentersOf(const std::vector<BackgroundReference>& backgrounds,
                                    SegmentationMethod method) {
  SegmentationOptions options;
  options.method = method;
  std::vector<Segmenter> segmenters;
  for (const BackgroundReference& background : backgrounds) segmenters.emplace_back(background, options);
  return segmenters;
}

// The error under steady light is that of the plain method: what a changing light may cost is twice as much.
// The plain method itself fails this: were it not so, the scenes would ask for nothing.
TEST(ChangingLight, AdaptiveSilhouettesAreAtMostTwiceAsWrongAsUnderSteadyLight) {
  constexpr double kMostRatio = 2.0;
  double worst = 0.0, worst_plain = 0.0;
  bool has_large = false;
  for (const LitScene& scene : LitScenes()) {
    has_large |= scene.object_share > 1.0 / 3.0;
    const auto backgrounds = BackgroundsOf(scene, kSensorNoiseLevels);
    const auto plain = SegmentersOf(backgrounds, SegmentationMethod::kThreshold);
    const auto adaptive = SegmentersOf(backgrounds, SegmentationMethod::kAdaptive);
    const double steady = WrongShare(scene, plain, LightChange::kSteady, kSensorNoiseLevels, kLitFrames);
    ASSERT_GT(steady, 0.0) << scene.name;
    for (const LightChange change : kLightChanges) {
      const double ratio = WrongShare(scene, adaptive, change, kSensorNoiseLevels, kLitFrames) / steady;
      EXPECT_LE(ratio, kMostRatio) << scene.name << ", " << ToString(change);
      worst = std::max(worst, ratio);
    }
    const LightChange both = LightChange::kFlickerAndDrift;
    worst_plain =
        std::max(worst_plain, WrongShare(scene, plain, both, kSensorNoiseLevels, kLitFrames) / steady);
  }
  RecordProperty("worst_ratio", std::to_string(worst));
  RecordProperty("worst_ratio_plain", std::to_string(worst_plain));
  EXPECT_TRUE(has_large);
  EXPECT_GT(worst_plain, kMostRatio);
}

}  // namespace
}  // namespace elbowroom::recon
