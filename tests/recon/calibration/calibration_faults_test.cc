// What is wrong with the pictures: flips, wrong views, cameras that don't join.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "recon/calibration/board_surface.h"
#include "recon/calibration/calibrate.h"
#include "recon/calibration/planar_pose.h"
#include "recon/calibration/rig_covariance.h"
#include "recon/calibration/rotation.h"
#include "tests/recon/calibration/calibration_scene.h"

namespace elbowroom::recon {
namespace {

CalibrationScene SmallScene(std::uint64_t seed, double wrong_share = 0.0) {
  CalibrationSceneOptions options = StillBoardOptions();
  options.cameras = 3;
  options.runs = 25;
  options.wrong_share = wrong_share;
  return MakeCalibrationScene(options, seed);
}

std::string RefusalOf(const CalibrationInput& input, core::ErrorKind kind = core::ErrorKind::kCamera) {
  try {
    (void)Calibrate(input);
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  ADD_FAILURE() << "it was not refused";
  return {};
}

void ExpectInMessage(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nhas no: " << part;
}

TEST(PlanarPose, KeepsBothMinimaAndTheTrueOneIsAmongThem) {
  const BoardSurface surface(CalibrationSceneOptions{}.board);
  LensParameters lens;
  lens.values = Eigen::VectorXd::Zero(9);
  lens.values.head<4>() << 700.0, 700.0, 320.0, 240.0;
  Random random(1);
  int pairs = 0;
  for (int i = 0; i < 200; ++i) {
    // Facing the camera (a half turn about x), then tilted.
    const core::RigidTransform truth{
        RotationFromVector({std::numbers::pi, 0.0, 0.0}) *
            RotationFromVector(
                random.Uniform(0.2, 0.9) *
                Eigen::Vector3d(random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0), 0.0).normalized()),
        {random.Uniform(-200.0, 200.0), random.Uniform(-200.0, 200.0), random.Uniform(1200.0, 2500.0)}};
    std::vector<PosePoint> points;
    std::vector<Eigen::Vector2d> normalised;
    for (int p = 0; p < surface.points(); ++p) {
      const Eigen::Vector2d pixel =
          ProjectPoint(lens, truth * surface.Flat(p)).value() +
          0.3 * Eigen::Vector2d(random.Uniform(-1.7, 1.7), random.Uniform(-1.7, 1.7));
      points.push_back({surface.Flat(p), pixel, 5.0});
      normalised.push_back(NormalisedPoint(lens, pixel).value());
    }
    const std::vector<PlanarPose> poses = PlanarPosesOf(lens, points, normalised);
    ASSERT_FALSE(poses.empty());
    EXPECT_TRUE(std::ranges::any_of(poses, [&](const PlanarPose& pose) {
      return VectorFromRotation(pose.cam_from_board.rotation.transpose() * truth.rotation).norm() < 0.12;
    })) << i;
    if (poses.size() == 2) {
      ++pairs;
      EXPECT_LE(poses[0].error.rms_px, poses[1].error.rms_px);
    }
    for (const PlanarPose& pose : poses) EXPECT_TRUE(ShowsPrintedSide(pose.cam_from_board, surface.center()));
  }
  EXPECT_GT(pairs, 100);
}

TEST(PlanarPose, PointsOnALineHaveNone) {
  LensParameters lens;
  lens.values = Eigen::VectorXd::Zero(9);
  lens.values.head<4>() << 700.0, 700.0, 320.0, 240.0;
  std::vector<PosePoint> points;
  std::vector<Eigen::Vector2d> normalised;
  for (int i = 0; i < 6; ++i) {
    points.push_back({Eigen::Vector3d(30.0 * i, 0.0, 0.0), {100.0 + 20.0 * i, 200.0}, 5.0});
    normalised.push_back(NormalisedPoint(lens, points.back().pixel).value());
  }
  EXPECT_TRUE(PlanarPosesOf(lens, points, normalised).empty());
  EXPECT_TRUE(PlanarPosesOf(lens, {points.data(), 3}, {normalised.data(), 3}).empty());
}

TEST(CalibrationFaults, NoFlippedBoardIsAccepted) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CalibrationScene scene = SmallScene(seed, 0.2);
    const CalibrationResult result = Calibrate(scene.input);
    EXPECT_GT(result.boards.size(), 12U);
    for (const BoardPose& board : result.boards) {
      const core::RigidTransform& truth = scene.world_from_board[static_cast<std::size_t>(board.set)];
      EXPECT_LE(VectorFromRotation(board.world_from_board.rotation.transpose() * truth.rotation).norm(), 0.05)
          << "seed " << seed << " set " << board.set;
    }
  }
}

TEST(CalibrationFaults, WrongViewsAreLeftOutWithTheirReason) {
  const CalibrationScene scene = SmallScene(4, 0.15);
  const CalibrationResult result = Calibrate(scene.input);
  ASSERT_EQ(result.views.size(), scene.is_wrong.size());
  EXPECT_NEAR(result.noise_px, 0.3, 0.02);
  for (std::size_t i = 0; i < result.views.size(); ++i)
    EXPECT_EQ(result.views[i].is_used, result.views[i].reason.empty()) << i;
  int right = 0, used = 0;
  for (std::size_t i = 0; i < result.views.size(); ++i) {
    if (scene.is_wrong[i]) continue;
    ++right;
    used += result.views[i].is_used ? 1 : 0;
  }
  EXPECT_GT(used, right * 8 / 10);
}

TEST(CalibrationFaults, CamerasThatShareNoViewAreNamed) {
  CalibrationScene scene = SmallScene(5);
  // The third camera's views are pictures for its lens alone.
  for (CalibrationView& view : scene.input.views)
    if (view.camera == 2) view.set.reset();
  ExpectInMessage(RefusalOf(scene.input),
                  {"'cam3'", "'cam1'", "share no view", "next, hold the board", "'cam3' both see it"});
}

TEST(CalibrationFaults, ACameraWithTooFewViewsIsNamed) {
  CalibrationScene scene = SmallScene(6);
  int kept = 0;
  std::erase_if(scene.input.views,
                [&](const CalibrationView& view) { return view.camera == 1 && ++kept > 2; });
  ExpectInMessage(RefusalOf(scene.input),
                  {"'cam2'", "2 of its views", "3 are needed", "next, take a picture"});
}

TEST(CalibrationFaults, AWorldThatNobodySeesIsNamed) {
  CalibrationScene scene = SmallScene(7);
  scene.input.world.number = 1000;
  ExpectInMessage(RefusalOf(scene.input), {"set 1000", "cam1", "next"});
}

TEST(CalibrationFaults, PointsThatTheBoardDoesNotHaveAreNamed) {
  CalibrationScene scene = SmallScene(8);
  scene.input.views[3].sighting.points.back().point = 4000;
  ExpectInMessage(RefusalOf(scene.input), {scene.input.views[3].label.c_str(), "point 4000"});
}

// Photos for the lens alone: most have one pose, and their mirror image falls back to it.
TEST(CalibrationFaults, PhotosWithOneClearPoseAreUsed) {
  CalibrationSceneOptions options = StillBoardOptions();
  options.cameras = 2;
  options.runs = 15;
  options.lens_photos = 30;
  options.occluded_share = 0.0;
  const CalibrationScene scene = MakeCalibrationScene(options, 21);
  const CalibrationResult result = Calibrate(scene.input);
  int photos = 0, used = 0;
  for (std::size_t i = 0; i < result.views.size(); ++i) {
    if (scene.input.views[i].set) continue;
    ++photos;
    used += result.views[i].is_used ? 1 : 0;
  }
  EXPECT_EQ(photos, 60);
  EXPECT_GE(used, 57);
}

// A picture of which all points are shifted fits some pose of the board within a few pixels.
TEST(CalibrationFaults, APhotoThatContradictsTheLensIsLeftOut) {
  CalibrationSceneOptions options = StillBoardOptions();
  options.cameras = 2;
  options.runs = 15;
  options.lens_photos = 30;
  options.occluded_share = 0.0;
  CalibrationScene scene = MakeCalibrationScene(options, 22);
  std::vector<std::size_t> shifted;
  for (std::size_t i = 0; i < scene.input.views.size(); ++i) {
    CalibrationView& view = scene.input.views[i];
    if (view.set || view.label != "photo 7") continue;
    shifted.push_back(i);
    for (SightedPoint& point : view.sighting.points) point.pixel += Eigen::Vector2d(32.0, 24.0);
  }
  const CalibrationResult result = Calibrate(scene.input);
  ASSERT_EQ(shifted.size(), 2U);
  for (const std::size_t i : shifted) EXPECT_FALSE(result.views[i].is_used);
  for (int i = 0; i < 2; ++i) EXPECT_LE(ErrorOfCamera(scene, result, i).rotation_chi2, 30.0);
}

// Where the points of a view that are right lie on a line, they don't tell how the board is turned about it.
TEST(CalibrationFaults, AViewOfOneLineIsLeftOut) {
  CalibrationScene scene = SmallScene(23);
  BoardSighting& sighting = scene.input.views[20].sighting;
  ASSERT_GE(sighting.points.size(), 12U);
  const int row = sighting.points.front().point / 10;
  std::erase_if(sighting.points, [&](const SightedPoint& point) { return point.point / 10 > row + 1; });
  int number = 0;
  for (SightedPoint& point : sighting.points)
    if (point.point / 10 != row) point.pixel += Eigen::Vector2d(300.0 + 40.0 * (++number % 3), 200.0);
  const CalibrationResult result = Calibrate(scene.input);
  EXPECT_FALSE(result.views[20].is_used);
}

TEST(CalibrationFaults, ACameraOfWhichTooLittleIsKnownIsNamed) {
  const CalibrationScene scene = SmallScene(24);
  const BoardSurface surface(scene.input.board);
  Adjustment a;
  a.surface = &surface;
  for (const core::CameraCalibration& camera : scene.cameras)
    a.cameras.push_back({LensParametersOf(camera), camera.cam_from_world});
  a.boards.push_back({scene.world_from_board[0], 0.0, true});
  for (int i = 0; i < 2; ++i) {  // the third sees nothing
    a.cameras[static_cast<std::size_t>(i)].is_lens_fixed = true;
    AdjustedView view;
    view.camera = i;
    for (int p = 0; p < surface.points(); ++p)
      view.points.push_back({p,
                             ProjectPoint(a.cameras[static_cast<std::size_t>(i)].lens,
                                          scene.cameras[static_cast<std::size_t>(i)].cam_from_world *
                                              (scene.world_from_board[0] * surface.Flat(p)))
                                 .value(),
                             5.0});
    a.views.push_back(view);
  }
  try {
    (void)CovarianceOf(a, 1.0, scene.input);
    ADD_FAILURE() << "it was not refused";
  } catch (const core::Error& error) {
    ExpectInMessage(error.what(), {"camera 'cam3'", "next, take views with it", "tilted"});
  }
}

TEST(CalibrationFaults, AWorldThatOneUnclearViewShowsIsRefused) {
  CalibrationScene scene = SmallScene(25);
  std::erase_if(scene.input.views,
                [](const CalibrationView& view) { return view.set == 0 && view.camera != 0; });
  for (CalibrationView& view : scene.input.views)
    if (view.set == 0 && view.camera == 0) view.sighting.points.resize(2);
  ExpectInMessage(RefusalOf(scene.input), {"camera 'cam1'", "set 0", "next, take a picture"});
}

TEST(CalibrationFaults, AStillBoardTellsNoOffsets) {
  CalibrationScene scene = SmallScene(9);
  scene.input.finds_offsets = true;  // each set by itself, seconds apart
  const CalibrationResult result = Calibrate(scene.input);
  ASSERT_FALSE(result.warnings.empty());
  ExpectInMessage(result.warnings.front(), {"time offsets can't be found", "Record a video"});
  for (const CalibratedCamera& camera : result.cameras) EXPECT_FALSE(camera.time_offset_sigma_s);
}

}  // namespace
}  // namespace elbowroom::recon
