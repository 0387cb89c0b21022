// docs/calibration.md, "calibrate": whole runs of `calibrate` on made pictures.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "recon/boards/board_drawing.h"
#include "tests/accuracy/measurements.h"
#include "tests/recon/boards/board_picture.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::accuracy {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr int kCameras = 4, kFrames = 100;

recon::Board BoardOf(recon::BoardKind kind) {
  if (kind == recon::BoardKind::kChessboard) return {kind, 9, 6, 40.0, 0.0, ""};
  return {kind, 10, 7, 40.0, 30.0, "DICT_5X5_100"};
}

std::vector<core::CameraCalibration> Cameras(const Vector3d& middle) {
  std::vector<core::CameraCalibration> cameras;
  for (int i = 0; i < kCameras; ++i) {
    core::CameraCalibration camera;
    camera.name = fmt::format("cam{}", i + 1);
    camera.image_width_px = 1280;
    camera.image_height_px = 720;
    camera.camera_matrix << 1000.0 + 10.0 * i, 0.0, 645.0, 0.0, 1001.0 + 10.0 * i, 352.0, 0.0, 0.0, 1.0;
    camera.distortion_coefficients = {-0.12 + 0.04 * i, 0.03, 4e-4, -3e-4, 0.0};
    const double angle = -2.3 + 0.9 * i;
    camera.cam_from_world = core::CamFromWorldLookingAt(
        middle + Vector3d(900.0 * std::cos(angle), 900.0 * std::sin(angle), 700.0 + 80.0 * i), middle);
    cameras.push_back(camera);
  }
  return cameras;
}

// A hand's motion, after two seconds on the table.
core::RigidTransform WorldFromBoard(int frame, const Vector3d& middle) {
  if (frame < 10) return {};
  const double t = 0.12 * (frame - 9);
  core::RigidTransform pose = core::FromPositionAndRollPitchYaw(
      Vector3d::Zero(),
      Vector3d(25.0 * std::sin(1.3 * t), 25.0 * std::sin(1.1 * t + 0.4), 30.0 * std::sin(0.7 * t)));
  const Vector3d to = middle + Vector3d(150.0 * std::sin(0.9 * t), 120.0 * std::sin(1.2 * t + 1.0),
                                        120.0 + 100.0 * std::sin(0.8 * t));
  pose.translation_mm = to - pose.rotation * middle;
  return pose;
}

// A room behind the board: blocks and lines of all sizes, as books, cables and tiles are.
cv::Mat Clutter(unsigned seed) {
  cv::RNG random(seed);
  cv::Mat room(720, 1280, CV_8UC3, cv::Scalar(120, 120, 120));
  for (int i = 0; i < 500; ++i) {
    const cv::Scalar color(random.uniform(20, 230), random.uniform(20, 230), random.uniform(20, 230));
    const cv::Point at(random.uniform(0, 1280), random.uniform(0, 720));
    const cv::Size size(random.uniform(5, 120), random.uniform(5, 120));
    if (i % 3 == 0)
      cv::line(room, at, at + cv::Point(size.width, size.height), color, 1 + i % 4, cv::LINE_AA);
    if (i % 3 == 1) cv::rectangle(room, {at, size}, color, cv::FILLED);
    if (i % 3 == 2) cv::ellipse(room, at, size / 3, i, 0, 360, color, cv::FILLED, cv::LINE_AA);
  }
  cv::Mat noise(room.size(), CV_16SC3), sum;
  random.fill(noise, cv::RNG::NORMAL, 0, 3);
  room.convertTo(sum, CV_16SC3);
  cv::add(sum, noise, sum);
  sum.convertTo(room, CV_8UC3);
  cv::GaussianBlur(room, room, {}, 0.7);
  return room;
}

// Where the board isn't, the picture has its surround's level, to the noise.
cv::Mat Over(const cv::Mat& board, const cv::Mat& outline, const cv::Mat& room) {
  cv::Mat picture = room.clone();
  board.copyTo(picture, outline);
  return picture;
}

void DrawPictures(const recon::Board& board, bool is_cluttered, const fs::path& folder) {
  const recon::BoardDrawing drawing = recon::DrawBoard(board);
  const Vector3d middle(180.0, -120.0, 0.0);
  for (const core::CameraCalibration& camera : Cameras(middle)) {
    fs::create_directories(folder / camera.name);
    const cv::Mat room = Clutter(static_cast<unsigned>(camera.name.back()));
    tbb::parallel_for(0, kFrames, [&](int frame) {
      core::CameraCalibration cam_from_board = camera;
      cam_from_board.cam_from_world = camera.cam_from_world * WorldFromBoard(frame, middle);
      const core::CameraModel model(cam_from_board);
      recon::testing::PictureOptions options;
      options.seed = static_cast<unsigned>(frame + 1);
      cv::Mat picture = recon::testing::PictureOf(drawing, model, options);
      if (picture.channels() == 1) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
      if (is_cluttered) {
        options.noise_levels = 0.0;
        options.light = options.dark = 255.0;
        options.surround = 0.0;
        cv::Mat outline = recon::testing::PictureOf(drawing, model, options);
        if (outline.channels() == 3) cv::cvtColor(outline, outline, cv::COLOR_BGR2GRAY);
        picture = Over(picture, outline > 127, room);
      }
      cv::imwrite((folder / camera.name / fmt::format("{:03}.jpg", frame)).string(), picture,
                  {cv::IMWRITE_JPEG_QUALITY, 92});
    });
  }
}

std::string CalibrationText(const recon::Board& board) {
  std::string text = fmt::format("[board]\ntype = \"{}\"\ncolumns = {}\nrows = {}\nsquare_mm = {}\n",
                                 recon::ToString(board.kind), board.columns, board.rows, board.square_mm);
  if (board.has_markers())
    text += fmt::format("marker_mm = {}\ndictionary = \"{}\"\n", board.marker_mm, board.dictionary);
  for (int i = 1; i <= kCameras; ++i)
    text += fmt::format("[[camera]]\nname = \"cam{0}\"\nframes = \"cam{0}/*.jpg\"\n", i);
  return text + "[world]\nboard_frame = 0\nworkspace_mm = [-120, -420, 0, 480, 180, 400]\n";
}

}  // namespace

void MeasureCalibration(const fs::path& docs, const fs::path& program) {
  reporting::Table table{{"board", "room", "views found, of 400", "whole command, s",
                          "of it the fit and the map, s", "kept out, px", "error of a point, mm"},
                         {}};
  for (const recon::BoardKind kind : {recon::BoardKind::kCharuco, recon::BoardKind::kChessboard}) {
    for (const bool is_cluttered : {false, true}) {
      const test_support::TemporaryFolder folder;
      fmt::print(stderr, "calibration: {}, {}\n", recon::ToString(kind),
                 is_cluttered ? "cluttered" : "plain");
      DrawPictures(BoardOf(kind), is_cluttered, folder.path());
      test_support::WriteText(folder / "CALIB.toml", CalibrationText(BoardOf(kind)));
      const auto start = std::chrono::steady_clock::now();
      const test_support::ProgramRun run = test_support::RunProgram(
          program,
          {"calibrate", (folder / "CALIB.toml").string(), "--out", (folder / "rig.yml").string(), "--json"});
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (run.exit_status != 0) throw core::Error(core::ErrorKind::kFile, run.err);
      const auto json = nlohmann::json::parse(run.out);
      int views = 0;
      for (const auto& camera : json["cameras"])
        views += camera["views"].get<int>() + camera["rejected_views"].get<int>();
      table.rows.push_back({std::string(recon::ToString(kind)), is_cluttered ? "cluttered" : "plain",
                            std::to_string(views), fmt::format("{:.1f}", seconds),
                            fmt::format("{:.1f}", 1e-3 * json["time_ms"].get<double>()),
                            fmt::format("{:.3f}", json["held_out_rms_px"].get<double>()),
                            fmt::format("{:.2f}", json["uncertainty_mm"]["median"].get<double>())});
      fmt::print(stderr, "  {:.1f} s\n", seconds);
    }
  }
  reporting::WriteSection(
      docs / "calibration.md", "calibrate",
      fmt::format("{} cameras of 1280 x 720, {} pictures each.\n\n{}\n{}", kCameras, kFrames,
                  reporting::ToMarkdown(table), reporting::ToLine(reporting::ThisMachine(docs / ".."))));
}

}  // namespace elbowroom::accuracy
