// Boards whose pose nothing confirms.
#include "recon/calibration/board_certainty.h"

#include <gtest/gtest.h>

#include <cmath>

#include "recon/calibration/calibrate.h"
#include "recon/calibration/lens_fit.h"
#include "recon/calibration/rotation.h"
#include "tests/recon/calibration/calibration_scene.h"

namespace elbowroom::recon {
namespace {

// In the first of these rigs a camera alone saw the board at its instant, in a wrong picture; in the others,
// two cameras that were late and early by half a period left the boards' poses at the stamps between
// undecided.
TEST(BoardCertainty, ABoardThatNothingConfirmsIsntAccepted) {
  constexpr double kMostTurnRad = 0.05;
  for (const std::uint64_t seed : {185U, 293U, 310U}) {
    const CalibrationScene scene = MakeCalibrationScene(RecommendedSceneOptions(seed), seed);
    const CalibrationResult result = Calibrate(scene.input);
    EXPECT_GT(result.boards.size(), scene.world_from_board.size() / 3);
    for (const BoardPose& board : result.boards) {
      const core::RigidTransform& truth = scene.world_from_board[static_cast<std::size_t>(board.set)];
      EXPECT_LE(VectorFromRotation(board.world_from_board.rotation.transpose() * truth.rotation).norm(),
                kMostTurnRad)
          << "seed " << seed << " set " << board.set;
    }
  }
}

// One board before cameras whose pictures are of these instants, in frame periods after the board's.
class SigmaByInstants : public ::testing::Test {
 protected:
  double SigmaOfMiddle(const std::vector<std::vector<double>>& instants_of_cameras) {
    Adjustment a;
    a.surface = &surface_;
    for (std::size_t i = 0; i < instants_of_cameras.size(); ++i)
      a.cameras.push_back({LensParametersOf(scene_.cameras[i]), scene_.cameras[i].cam_from_world});
    for (int k = 0; k < 3; ++k) a.boards.push_back({scene_.world_from_board[0], 1.0 * k, false});
    for (int i = 0; i < static_cast<int>(instants_of_cameras.size()); ++i)
      for (const double t : instants_of_cameras[static_cast<std::size_t>(i)]) {
        AdjustedView view;
        view.camera = i;
        view.boards = {1, 0, 2};
        view.board_count = 3;
        view.time_s = t;
        view.points = AdjustedPointsOf(scene_.input.views[static_cast<std::size_t>(i)].sighting);
        a.views.push_back(std::move(view));
      }
    return ConfirmedTurnSigmas(a, 1.5)[1];
  }

  CalibrationScene scene_ = MakeCalibrationScene(StillBoardOptions(), 33);
  BoardSurface surface_{scene_.input.board};
};

TEST_F(SigmaByInstants, TwoCamerasAtEachInstantConfirm) {
  EXPECT_LE(SigmaOfMiddle({{0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}}), 0.01);
}

TEST_F(SigmaByInstants, OneCameraAtTheInstantDoesntConfirm) {
  EXPECT_GT(SigmaOfMiddle({{0.0, 1.0, 2.0}, {0.0, 2.0}}), 1.0);
}

TEST_F(SigmaByInstants, TwoInstantsForThreeBoardsDontConfirm) {
  EXPECT_GT(SigmaOfMiddle({{0.5, 1.5}, {0.5, 1.5}}), 1.0);
}

TEST_F(SigmaByInstants, AnotherCameraBetweenTheInstantsConfirms) {
  EXPECT_LE(SigmaOfMiddle({{0.0, 1.0, 2.0}, {0.5, 1.5}}), 0.01);
}

}  // namespace
}  // namespace elbowroom::recon
