// Which distortion model a lens is taken to have.
#include "recon/calibration/lens_choice.h"

#include <gtest/gtest.h>

#include <vector>

#include "recon/calibration/calibrate.h"
#include "recon/calibration/lens_fit.h"
#include "tests/recon/calibration/calibration_scene.h"

namespace elbowroom::recon {
namespace {

using core::DistortionModel;

struct SeededCamera {
  std::uint64_t seed;
  int camera;
  DistortionModel true_model;
};

// These were once taken for another model: a fisheye for a plumb_bob by its middle, and plumb_bob and
// rational lenses for a fisheye, which put their tangential terms into the principal point and turned the
// camera by 5 to 17 of its sigmas.
const SeededCamera kOnceWrong[] = {{12, 5, DistortionModel::kFisheye},
                                   {14, 5, DistortionModel::kPlumbBob},
                                   {20, 1, DistortionModel::kFisheye}};

TEST(LensChoice, AnotherModelThanTheLensHasDoesntMoveTheCamera) {
  constexpr double kMostChi2 = 21.1;  // of three degrees of freedom; one in 10,000 is above it
  for (const auto& [seed, camera, true_model] : kOnceWrong) {
    const CalibrationScene scene = MakeCalibrationScene(RecommendedSceneOptions(seed), seed);
    ASSERT_EQ(scene.cameras[static_cast<std::size_t>(camera)].distortion_model, true_model) << seed;
    const CalibrationResult result = Calibrate(scene.input);
    const CameraError error = ErrorOfCamera(scene, result, camera);
    EXPECT_LE(error.rotation_chi2, kMostChi2) << "seed " << seed << " camera " << camera;
    EXPECT_LE(error.center_chi2, kMostChi2) << "seed " << seed << " camera " << camera;
  }
}

// The true cameras and boards of a scene without wrong views.
Adjustment TruthOf(const CalibrationScene& scene, const BoardSurface& surface) {
  Adjustment a;
  a.surface = &surface;
  for (const core::CameraCalibration& camera : scene.cameras)
    a.cameras.push_back({LensParametersOf(camera), camera.cam_from_world});
  for (const core::RigidTransform& board : scene.world_from_board) a.boards.push_back({board, 0.0, false});
  for (const CalibrationView& seen : scene.input.views) {
    AdjustedView view;
    view.camera = seen.camera;
    view.boards[0] = *seen.set;
    view.points = AdjustedPointsOf(seen.sighting);
    a.views.push_back(std::move(view));
  }
  return a;
}

TEST(LensChoice, ALensWithTangentialTermsIsNoFisheyeWhateverItIsTakenForAtFirst) {
  CalibrationSceneOptions options = StillBoardOptions();
  options.cameras = 3;
  options.has_plain_lenses = true;
  const CalibrationScene scene = MakeCalibrationScene(options, 31);
  const BoardSurface surface(options.board);
  const double noise_scale = options.noise_px / options.sigma_px;
  for (const DistortionModel present :
       {DistortionModel::kPlumbBob, DistortionModel::kRationalPolynomial, DistortionModel::kFisheye})
    for (int camera = 0; camera < options.cameras; ++camera) {
      Adjustment rig = TruthOf(scene, surface);
      LensParameters& lens = rig.cameras[static_cast<std::size_t>(camera)].lens;
      lens = WithModel(lens, present);
      EXPECT_NE(ChooseLens(rig, camera, noise_scale, {}).model, DistortionModel::kFisheye) << camera;
    }
}

TEST(LensChoice, TheModelThatThePicturesTellStaysAsItIs) {
  CalibrationSceneOptions options = StillBoardOptions();
  options.cameras = 3;
  options.has_plain_lenses = true;
  options.noise_px = 1e-3;  // so that all coefficients count
  const CalibrationScene scene = MakeCalibrationScene(options, 32);
  const BoardSurface surface(options.board);
  const Adjustment rig = TruthOf(scene, surface);
  const LensParameters chosen = ChooseLens(rig, 1, options.noise_px / options.sigma_px, {});
  EXPECT_EQ(chosen.model, DistortionModel::kPlumbBob);
  EXPECT_TRUE(chosen.values == rig.cameras[1].lens.values);
}

}  // namespace
}  // namespace elbowroom::recon
