#include "tests/accuracy/chain/chain_rig.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "app/control/calibration/calibration_file.h"
#include "app/control/calibration/calibration_job.h"
#include "core/error.h"
#include "recon/boards/board_drawing.h"
#include "tests/recon/boards/board_picture.h"
#include "tests/recon/consistency/moving_hands.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::accuracy {
namespace {

namespace fs = std::filesystem;
using core::RigidTransform;
using Eigen::Vector3d;
using recon::Random;

constexpr int kColumns = 9, kRows = 6;
constexpr double kSquareMm = 60.0, kMarkerMm = 46.0;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kHalfSideMm = 330.0, kFromZMm = -20.0, kToZMm = 430.0;  // of the workspace

recon::Board ChainBoard() {
  return {recon::BoardKind::kCharuco, kColumns, kRows, kSquareMm, kMarkerMm, "DICT_4X4_50"};
}

Vector3d BoardMiddle() { return {0.5 * kColumns * kSquareMm, -0.5 * kRows * kSquareMm, 0.0}; }

// Those of HandRig, with everything off by what two cameras of one kind differ.
core::Rig DrawRig(const ChainRigOptions& options, Random* random) {
  constexpr double kMostEyeMm = 60.0, kMostTargetMm = 30.0, kMostPrincipalPx = 10.0;
  const auto off = [&](double most) {
    return Vector3d(random->Uniform(-most, most), random->Uniform(-most, most), random->Uniform(-most, most));
  };
  const core::Rig model = recon::testing::HandRig(options.cameras);
  const Vector3d hands_middle(model.workspace_mm.center().x(), model.workspace_mm.center().y(), 0.0);
  core::Rig rig;
  rig.name = "chain";
  rig.workspace_mm = {BoardMiddle() + Vector3d(-kHalfSideMm, -kHalfSideMm, kFromZMm),
                      BoardMiddle() + Vector3d(kHalfSideMm, kHalfSideMm, kToZMm)};
  for (const core::CameraModel& of_model : model.cameras) {
    core::CameraCalibration camera = of_model.calibration();
    const Vector3d eye = of_model.center_in_world() - hands_middle + BoardMiddle() + off(kMostEyeMm);
    camera.cam_from_world = core::CamFromWorldLookingAt(eye, ChainMiddleInWorld() + off(kMostTargetMm));
    const double scale = options.picture_scale, focal = random->Uniform(0.97, 1.03);
    camera.image_width_px = static_cast<int>(camera.image_width_px * scale);
    camera.image_height_px = static_cast<int>(camera.image_height_px * scale);
    camera.camera_matrix.topRows<2>() *= scale;
    camera.camera_matrix(0, 0) *= focal;
    camera.camera_matrix(1, 1) *= focal * random->Uniform(0.999, 1.001);
    camera.camera_matrix(0, 2) += scale * random->Uniform(-kMostPrincipalPx, kMostPrincipalPx);
    camera.camera_matrix(1, 2) += scale * random->Uniform(-kMostPrincipalPx, kMostPrincipalPx);
    camera.distortion_coefficients = {random->Uniform(-0.15, 0.0), random->Uniform(-0.02, 0.05),
                                      random->Uniform(-5e-4, 5e-4), random->Uniform(-5e-4, 5e-4), 0.0};
    rig.cameras.emplace_back(camera);
  }
  rig.Validate();
  return rig;
}

// On the table first, then held anywhere above it, tilted to any side and turned.
std::vector<RigidTransform> DrawBoardPoses(int count, Random* random) {
  std::vector<RigidTransform> world_from_boards{RigidTransform()};
  for (int i = 0; i < count; ++i) {
    const double towards = random->Uniform(0.0, 2.0 * std::numbers::pi);
    const Vector3d axis(std::cos(towards), std::sin(towards), 0.0);
    RigidTransform pose;
    pose.rotation =
        (Eigen::AngleAxisd(random->Uniform(10.0, 55.0) * kDegree, axis) *
         Eigen::AngleAxisd(random->Uniform(-std::numbers::pi, std::numbers::pi), Vector3d::UnitZ()))
            .toRotationMatrix();
    const Vector3d to =
        BoardMiddle() + Vector3d(random->Uniform(-150.0, 150.0), random->Uniform(-150.0, 150.0),
                                 random->Uniform(60.0, 300.0));
    pose.translation_mm = to - pose.rotation * BoardMiddle();
    world_from_boards.push_back(pose);
  }
  return world_from_boards;
}

// No hand holds a board quite still, and no two cameras look at the same instant: where one sees it instead.
RigidTransform HeldByAHand(const RigidTransform& world_from_board, Random* random) {
  constexpr double kTrembleMmPerS = 20.0, kTrembleRadPerS = 0.05, kMostSkewS = 1.0 / 60.0;
  const double late_s = random->Uniform(-kMostSkewS, kMostSkewS);
  RigidTransform world_from_held = world_from_board;
  world_from_held.rotation =
      Eigen::AngleAxisd(kTrembleRadPerS * late_s, random->Direction()).toRotationMatrix() *
      world_from_board.rotation;
  world_from_held.translation_mm = world_from_board * BoardMiddle() -
                                   world_from_held.rotation * BoardMiddle() +
                                   kTrembleMmPerS * late_s * random->Direction();
  return world_from_held;
}

// A board's back shows nothing.
cv::Mat PictureOfBoard(const recon::BoardDrawing& drawing, const core::CameraModel& camera,
                       const RigidTransform& world_from_board, unsigned seed) {
  core::CameraCalibration to_board = camera.calibration();
  to_board.cam_from_world = to_board.cam_from_world * world_from_board;
  // As grey and as noisy as an indoor picture is, so that points are off as in real ones (calibration.md).
  const recon::testing::PictureOptions options{170.0, 40.0, 100.0, 0.8, 5.0, seed};
  if ((world_from_board.Inverse() * camera.center_in_world()).z() <= 0.0)
    return {camera.height_px(), camera.width_px(), CV_8U, cv::Scalar(options.surround)};
  return recon::testing::PictureOf(drawing, core::CameraModel(to_board), options);
}

void DrawPictures(const core::Rig& truth, const std::vector<RigidTransform>& world_from_boards,
                  std::uint64_t seed, const core::Progress& progress, const fs::path& folder) {
  const recon::BoardDrawing drawing = recon::DrawBoard(ChainBoard());
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    const core::CameraModel& camera = truth.cameras[i];
    progress.Report(static_cast<std::int64_t>(i), std::ssize(truth.cameras), "drawing the board");
    fs::create_directories(folder / camera.name());
    tbb::parallel_for(std::size_t{0}, world_from_boards.size(), [&](std::size_t pose) {
      const auto number = static_cast<unsigned>(1000 * seed + 100 * i + pose + 1);
      Random random(number);
      const RigidTransform& world_from_board = world_from_boards[pose];
      const cv::Mat picture = PictureOfBoard(
          drawing, camera, pose == 0 ? world_from_board : HeldByAHand(world_from_board, &random), number);
      const fs::path file = folder / camera.name() / fmt::format("{:03}.png", pose);
      if (!cv::imwrite(file.string(), picture))
        throw core::Error(core::ErrorKind::kFile, fmt::format("'{}' can't be written", file.string()));
    });
  }
}

std::string CalibrationText(const core::Rig& rig) {
  const recon::Board board = ChainBoard();
  std::string text = fmt::format(
      "[board]\ntype = \"charuco\"\ncolumns = {}\nrows = {}\nsquare_mm = {}\nmarker_mm = {}\ndictionary = "
      "\"{}\"\n",
      board.columns, board.rows, board.square_mm, board.marker_mm, board.dictionary);
  for (const core::CameraModel& camera : rig.cameras)
    text += fmt::format("[[camera]]\nname = \"{0}\"\nframes = \"{0}/*.png\"\n", camera.name());
  const Vector3d &from = rig.workspace_mm.min(), &to = rig.workspace_mm.max();
  return text + fmt::format("[world]\nboard_frame = 0\nworkspace_mm = [{}, {}, {}, {}, {}, {}]\n", from.x(),
                            from.y(), from.z(), to.x(), to.y(), to.z());
}

}  // namespace

Vector3d ChainMiddleInWorld() { return BoardMiddle() + Vector3d(0.0, 0.0, 200.0); }

ChainRig MakeChainRig(const ChainRigOptions& options, std::uint64_t seed, const core::Progress& progress) {
  Random random(seed);
  ChainRig rig;
  rig.truth = DrawRig(options, &random);
  const test_support::TemporaryFolder folder;
  DrawPictures(rig.truth, DrawBoardPoses(options.board_poses, &random), seed, progress, folder.path());
  test_support::WriteText(folder / "CALIB.toml", CalibrationText(rig.truth));
  const control::CalibrationOutcome outcome =
      control::CalibrateRig(control::ReadCalibrationFile(folder / "CALIB.toml"), "chain", progress, {});
  rig.estimate = outcome.rig_file.rig;
  rig.quality = recon::QualityOf(outcome.rig_file);
  rig.held_out_px = outcome.result.held_out_rms_px.value_or(0.0);
  for (std::size_t i = 0; i < rig.truth.cameras.size(); ++i) {
    const Vector3d off = rig.estimate.cameras[i].center_in_world() - rig.truth.cameras[i].center_in_world();
    rig.center_error_mm += off.norm() / static_cast<double>(rig.truth.cameras.size());
  }
  return rig;
}

}  // namespace elbowroom::accuracy
