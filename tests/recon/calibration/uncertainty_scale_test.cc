// Uncertainties where the points of a view are off together.
#include "recon/calibration/uncertainty_scale.h"

#include <gtest/gtest.h>

#include <cmath>

#include "recon/calibration/calibrate.h"
#include "tests/recon/calibration/calibration_scene.h"

namespace elbowroom::recon {
namespace {

CalibrationSceneOptions ManySets() {
  CalibrationSceneOptions options = StillBoardOptions();
  options.runs = 60;
  return options;
}

// Each view but those of the world's set is sheared along its rows, as a rolling shutter does to a board that
// moves.
void Shear(double most_px, std::uint64_t seed, CalibrationInput* input) {
  Random random(seed);
  for (CalibrationView& view : input->views) {
    const double px = random.Uniform(-most_px, most_px);
    if (view.set == 0) continue;
    const double height_px = input->cameras[static_cast<std::size_t>(view.camera)].height_px;
    for (SightedPoint& point : view.sighting.points)
      point.pixel.x() += px * (point.pixel.y() / height_px - 0.5);
  }
}

double MeanCenterChi2(const CalibrationScene& scene, const CalibrationResult& result) {
  double sum = 0.0;
  for (int i = 0; i < static_cast<int>(scene.cameras.size()); ++i)
    sum += ErrorOfCamera(scene, result, i).center_chi2;
  return sum / static_cast<double>(scene.cameras.size());
}

TEST(UncertaintyScale, IsOneWithIndependentNoise) {
  for (std::uint64_t seed = 41; seed < 45; ++seed) {
    const CalibrationResult result = Calibrate(MakeCalibrationScene(ManySets(), seed).input);
    EXPECT_EQ(result.uncertainty_scale, 1.0) << seed;
    EXPECT_TRUE(result.warnings.empty()) << result.warnings.front();
  }
}

TEST(UncertaintyScale, IsTheExcessWhereViewsAreOffAsAWhole) {
  double sum = 0.0;
  constexpr std::uint64_t kFirst = 51, kEnd = 58;
  for (std::uint64_t seed = kFirst; seed < kEnd; ++seed) {
    CalibrationScene scene = MakeCalibrationScene(ManySets(), seed);
    Shear(6.0, seed, &scene.input);
    const CalibrationResult result = Calibrate(scene.input);
    EXPECT_GE(result.uncertainty_scale, 2.0) << seed;
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_NE(result.warnings.front().find("off together"), std::string::npos) << result.warnings.front();
    sum += MeanCenterChi2(scene, result);
  }
  EXPECT_GE(sum / static_cast<double>(kEnd - kFirst), 0.5);
  EXPECT_LE(sum / static_cast<double>(kEnd - kFirst), 6.0) << "3 are expected";
}

}  // namespace
}  // namespace elbowroom::recon
