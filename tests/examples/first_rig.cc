#include "tests/examples/first_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "core/error.h"
#include "recon/boards/board_drawing.h"
#include "recon/synthetic/actors.h"
#include "recon/synthetic/camera_view.h"
#include "recon/synthetic/highest_point.h"
#include "tests/recon/boards/board_picture.h"

namespace elbowroom::examples {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

constexpr int kQuality = 85;  // of the JPEG files
const Vector3d kMiddle(105.0, -75.0, 40.0);

core::RigidTransform WorldFromBoard(int set) {
  if (set == 0) return {};
  const Vector3d tilt_deg(26.0 * std::sin(2.1 * set), 26.0 * std::cos(1.7 * set), 40.0 * std::sin(0.9 * set));
  core::RigidTransform world_from_board = core::FromPositionAndRollPitchYaw(Vector3d::Zero(), tilt_deg);
  const Vector3d middle_in_board(105.0, -75.0, 0.0);
  const Vector3d middle_in_world(kMiddle.x() + 70.0 * std::sin(1.3 * set),
                                 kMiddle.y() + 60.0 * std::cos(2.3 * set), 60.0 + 50.0 * std::sin(0.7 * set));
  world_from_board.translation_mm = middle_in_world - world_from_board.rotation * middle_in_board;
  return world_from_board;
}

// Places on a grid through the workspace, each with a direction of its own.
recon::Solid RodAt(int place) {
  const Vector3d middle =
      kMiddle + Vector3d(60.0 * (place % 3 - 1), 50.0 * (place / 3 - 1), 30.0 + 25.0 * (place % 2));
  const double turn = 0.7 * place;
  const Vector3d along = Vector3d(std::cos(turn), std::sin(turn), 0.3 * std::sin(2.0 * turn)).normalized();
  Eigen::Matrix3d rotation;
  rotation.col(2) = along;
  rotation.col(0) = along.unitOrthogonal();
  rotation.col(1) = along.cross(rotation.col(0));
  return {recon::Tube{0.5 * kRodDiameterMm, 0.0, kRodLengthMm},
          {rotation, middle - 0.5 * kRodLengthMm * along},
          Vector3d(150.0, 200.0, 235.0)};
}

// The hand comes from the side of negative y towards the bracket, and goes back.
std::vector<recon::Solid> HandAt(int frame) {
  const double share = 1.0 - std::abs(frame - 0.5 * (kHandFrames - 1)) / (0.5 * (kHandFrames - 1));
  const Vector3d wrist(105.0, -330.0 + 140.0 * share, 60.0);
  core::RigidTransform world_from_wrist;
  world_from_wrist.rotation << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;  // fingers along +y
  world_from_wrist.translation_mm = wrist;
  return recon::Hand(world_from_wrist, recon::OpenHand(), wrist - Vector3d(0.0, 260.0, -20.0)).solids;
}

// Draws a file's picture, unless only others are wanted.
class Drawer {
 public:
  Drawer(fs::path folder, const std::vector<std::string>& only) : folder_(std::move(folder)), only_(only) {}

  template <typename Picture>
  void Draw(const std::string& name, const Picture& draw) const {
    if (!only_.empty() && std::ranges::find(only_, name) == only_.end()) return;
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    core::Require(cv::imwrite(path.string(), draw(), {cv::IMWRITE_JPEG_QUALITY, kQuality}),
                  "the example's folder can be written");
  }

 private:
  fs::path folder_;
  const std::vector<std::string>& only_;
};

void DrawCamera(const core::CameraCalibration& calibration, const Drawer& drawer) {
  const recon::BoardDrawing drawing = recon::DrawBoard(FirstBoard());
  for (int set = 0; set < kBoardSets; ++set) {
    drawer.Draw(fmt::format("{}/board_{:02}.jpg", calibration.name, set), [&] {
      core::CameraCalibration cam_from_board = calibration;
      cam_from_board.cam_from_world = calibration.cam_from_world * WorldFromBoard(set);
      recon::testing::PictureOptions options;
      options.noise_levels = 1.0;
      options.seed = static_cast<unsigned>(set + 1);
      return recon::testing::PictureOf(drawing, core::CameraModel(cam_from_board), options);
    });
  }
  const recon::CameraView view(core::CameraModel(calibration), 7);
  recon::Exposure exposure;
  exposure.noise_sigma_levels = 1.0;
  exposure.samples_per_pixel_side = 4;
  drawer.Draw(calibration.name + "/empty.jpg", [&] { return view.Render({}, exposure); });
  for (int frame = 0; frame < kRodFrames + kHandFrames; ++frame) {
    drawer.Draw(fmt::format("{}/trial_{:02}.jpg", calibration.name, frame), [&] {
      exposure.noise_seed = static_cast<std::uint64_t>(frame + 1);
      return view.Render(frame < kRodFrames ? std::vector{RodAt(frame)} : HandAt(frame - kRodFrames),
                         exposure);
    });
  }
}

}  // namespace

std::optional<double> HighestOfHandMm(const Eigen::AlignedBox2d& above_mm) {
  std::optional<double> highest_mm;
  for (int frame = 0; frame < kHandFrames; ++frame)
    for (const recon::Solid& solid : HandAt(frame))
      highest_mm = std::max(highest_mm, recon::HighestZMm(solid, above_mm));
  return highest_mm;
}

recon::Board FirstBoard() {
  recon::Board board;
  board.kind = recon::BoardKind::kCharuco;
  board.columns = 7;
  board.rows = 5;
  board.square_mm = 30.0;
  board.marker_mm = 22.0;
  board.dictionary = "DICT_5X5_50";
  return board;
}

std::vector<core::CameraCalibration> FirstCameras() {
  std::vector<core::CameraCalibration> cameras;
  for (int i = 0; i < 3; ++i) {
    core::CameraCalibration camera;
    camera.name = fmt::format("cam{}", i + 1);
    camera.image_width_px = 480;
    camera.image_height_px = 360;
    camera.camera_matrix << 520.0 + 8.0 * i, 0.0, 242.0, 0.0, 520.5 + 8.0 * i, 178.0, 0.0, 0.0, 1.0;
    camera.distortion_coefficients = {-0.15 + 0.05 * i, 0.04, 0.0005, -0.0003, 0.0};
    const double angle = -2.0 + 1.1 * i;
    camera.cam_from_world = core::CamFromWorldLookingAt(
        kMiddle + Vector3d(480.0 * std::cos(angle), 480.0 * std::sin(angle), 430.0 + 30.0 * i), kMiddle);
    cameras.push_back(camera);
  }
  return cameras;
}

void DrawFirstRig(const fs::path& folder, const std::vector<std::string>& only) {
  for (const core::CameraCalibration& camera : FirstCameras()) DrawCamera(camera, {folder, only});
}

}  // namespace elbowroom::examples
