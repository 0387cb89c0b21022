// A wrong square size, which reprojection doesn't notice, is noticed by a known length.
#include "recon/calibration/known_length.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "recon/calibration/calibrate.h"
#include "tests/recon/calibration/calibration_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

CalibrationScene LengthScene() {
  CalibrationSceneOptions options = StillBoardOptions();
  options.runs = 25;
  return MakeCalibrationScene(options, 1);
}

KnownLength BetweenCameras(const CalibrationScene& scene) {
  KnownLength known;
  known.name = "cam1 to cam4";
  known.cameras = {0, 3};
  known.tolerance_mm = 2.0;
  known.length_mm = (scene.cameras[0].cam_from_world.Inverse().translation_mm -
                     scene.cameras[3].cam_from_world.Inverse().translation_mm)
                        .norm();
  return known;
}

// Two points of the table, where every camera sees them.
KnownLength BetweenPoints(const CalibrationScene& scene) {
  KnownLength known;
  known.name = "marks on the table";
  known.tolerance_mm = 0.5;
  const Vector3d a(-80.0, -120.0, 0.0), b(120.0, 150.0, 0.0);
  known.length_mm = (a - b).norm();
  for (int i = 0; i < 4; ++i) {
    const core::CameraModel model(scene.cameras[static_cast<std::size_t>(i)]);
    if (const auto pixel = model.Project(a)) known.first.push_back({i, *pixel, 0.3});
    if (const auto pixel = model.Project(b)) known.second.push_back({i, *pixel, 0.3});
  }
  return known;
}

TEST(KnownLength, AgreesWithARigOfTheRightScale) {
  const CalibrationScene scene = LengthScene();
  const CalibrationResult result = Calibrate(scene.input);
  for (const KnownLength& known : {BetweenCameras(scene), BetweenPoints(scene)}) {
    const LengthCheck check = CheckLength(result, known);
    EXPECT_EQ(check.verdict, LengthVerdict::kAgrees) << check.message;
    EXPECT_GT(check.sigma_mm, 0.0);
    EXPECT_NEAR(check.measured_mm, known.length_mm, 4.0 * check.sigma_mm);
  }
}

TEST(KnownLength, FindsAWrongSquareSizeThatReprojectionDoesNot) {
  CalibrationScene scene = LengthScene();
  const double right_px = Calibrate(scene.input).rms_px;
  scene.input.board.square_mm /= 1.02;  // the real squares are 2 % larger than stated
  scene.input.board.marker_mm /= 1.02;
  const CalibrationResult result = Calibrate(scene.input);
  EXPECT_NEAR(result.rms_px, right_px, 1e-3);
  for (const KnownLength& known : {BetweenCameras(scene), BetweenPoints(scene)}) {
    const LengthCheck check = CheckLength(result, known);
    EXPECT_EQ(check.verdict, LengthVerdict::kMismatch) << check.message;
    EXPECT_NE(check.message.find("larger than given"), std::string::npos) << check.message;
    EXPECT_NEAR(check.measured_mm * 1.02, known.length_mm, 0.005 * known.length_mm);
  }
}

TEST(KnownLength, CannotTellWithAWideTolerance) {
  const CalibrationScene scene = LengthScene();
  KnownLength known = BetweenPoints(scene);
  known.tolerance_mm = 0.1 * known.length_mm;
  EXPECT_EQ(CheckLength(Calibrate(scene.input), known).verdict, LengthVerdict::kCannotTell);
}

TEST(KnownLength, NeedsTwoPicturesOfEachPoint) {
  const CalibrationScene scene = LengthScene();
  const CalibrationResult result = Calibrate(scene.input);
  KnownLength known = BetweenPoints(scene);
  known.second.resize(1);
  try {
    (void)CheckLength(result, known);
    ADD_FAILURE() << "one picture was enough";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("marks on the table"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace elbowroom::recon
