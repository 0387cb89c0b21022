#include "app/control/calibration/calibration_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using test_support::TemporaryFolder;
using test_support::WriteText;

constexpr const char* kBoard = R"([board]
type = "charuco"
columns = 5
rows = 7
square_mm = 40.0
marker_mm = 20.0
dictionary = "DICT_6X6_250"
)";
constexpr const char* kCameras = R"([[camera]]
name = "cam1"
frames = "cam1/board.avi"
intrinsics = "cam1/photos/*.jpg"
[[camera]]
name = "cam2"
frames = "cam2/board.avi"
timestamps = "cam2/stamps.csv"
distortion_model = "fisheye"
known = "cam2.yml"
)";
constexpr const char* kWorld = R"([world]
board_frame = 3
workspace_mm = [-500, -400, 0, 500.0, 400, 600]
)";

class CalibrationText {
 public:
  [[nodiscard]] CalibrationFile Read(const std::string& text) const {
    WriteText(file(), text);
    return ReadCalibrationFile(file());
  }
  [[nodiscard]] std::string ErrorOf(const std::string& text) const {
    try {
      (void)Read(text);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "CALIB.toml"; }
  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

TEST(ReadCalibrationFile, TakesTheContractsExample) {
  const CalibrationText text;
  const CalibrationFile file = text.Read(std::string(kBoard) + kCameras + kWorld);
  EXPECT_EQ(file.board.kind, recon::BoardKind::kCharuco);
  EXPECT_EQ(file.board.columns, 5);
  EXPECT_EQ(file.board.rows, 7);
  EXPECT_EQ(file.board.layout, recon::CharucoLayout::kCurrent);
  EXPECT_FALSE(file.board.inverted);
  ASSERT_EQ(file.cameras.size(), 2U);
  EXPECT_EQ(file.cameras[0].frames, (text.folder() / "cam1/board.avi").string());
  EXPECT_EQ(file.cameras[0].intrinsics, (text.folder() / "cam1/photos/*.jpg").string());
  EXPECT_FALSE(file.cameras[0].lens_model.has_value());
  EXPECT_EQ(file.cameras[1].lens_model, core::DistortionModel::kFisheye);
  EXPECT_EQ(file.cameras[1].timestamps, text.folder() / "cam2/stamps.csv");
  EXPECT_EQ(file.cameras[1].known, text.folder() / "cam2.yml");
  EXPECT_EQ(file.board_frame, 3);
  EXPECT_EQ(file.workspace_mm.max(), Eigen::Vector3d(500, 400, 600));
  EXPECT_TRUE(file.lengths.empty());
}

TEST(ReadCalibrationFile, TakesKnownLengths) {
  const CalibrationText text;
  const CalibrationFile file = text.Read(std::string(kBoard) + kCameras + R"([[known_length]]
length_mm = 812.0
tolerance_mm = 3
cameras = ["cam1", "cam2"]
[[known_length]]
length_mm = 500.0
pixels = [{ camera = "cam1", from_px = [10.5, 20], to_px = [300, 21] },
          { camera = "cam2", from_px = [11, 22], to_px = [301.0, 25] }]
)" + kWorld);
  ASSERT_EQ(file.lengths.size(), 2U);
  EXPECT_EQ(file.lengths[0].cameras, (std::vector<std::string>{"cam1", "cam2"}));
  EXPECT_EQ(file.lengths[0].tolerance_mm, 3.0);
  ASSERT_EQ(file.lengths[1].pixels.size(), 2U);
  EXPECT_EQ(file.lengths[1].pixels[1].to_px, Eigen::Vector2d(301, 25));
}

TEST(ReadCalibrationFile, TakesLiveCamerasByName) {
  const CalibrationText text;
  WriteText(text.folder() / "cameras.yml", R"(%YAML:1.0
---
cameras:
  - { name: "cam2", image_width: 64, image_height: 48, frames: "gige:two" }
  - { name: "cam1", image_width: 64, image_height: 48, frames: "gige:one", capture: { rate_hz: 20, gain_db: 1 } }
)");
  const std::string live = "live = \"cameras.yml\"\n";
  const CalibrationFile file = text.Read(live + kBoard + kCameras + kWorld);
  EXPECT_EQ(file.cameras[0].trial.frames, "gige:one");
  EXPECT_EQ(file.cameras[0].trial.capture.rate_hz, 20.0);
  EXPECT_EQ(file.cameras[0].trial.capture.gain_db, 1.0);
  EXPECT_EQ(file.cameras[1].trial.frames, "gige:two");
  const std::string third = "[[camera]]\nname = \"cam3\"\nframes = \"cam3/board.avi\"\n";
  EXPECT_NE(text.ErrorOf(live + kBoard + kCameras + third + kWorld).find("without a camera 'cam3'"),
            std::string::npos);
  const std::string both = "[[camera]]\nname = \"cam1\"\nframes = \"b.avi\"\ntrial_frames = \"t.avi\"\n";
  EXPECT_NE(text.ErrorOf(live + kBoard + both + kWorld).find("both say where the pictures of camera 'cam1'"),
            std::string::npos);
}

TEST(ReadCalibrationFile, WhatIsWrongIsOneLineThatNamesThePlace) {
  const CalibrationText text;
  const std::string board(kBoard), cameras(kCameras), world(kWorld);
  const auto expect = [&](const std::string& wrong, std::string_view part) {
    const std::string error = text.ErrorOf(wrong);
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_TRUE(error.starts_with(text.file().string())) << error;
  };
  expect(cameras + world, "board");
  expect(board + world, "write a [[camera]] for each camera");
  expect(board + cameras, "[world]");
  expect("[board]\ntype = \"checkers\"\n" + cameras + world, "it must be \"chessboard\"");
  expect("[board]\ntype = \"chessboard\"\ncolumns = 8.5\nrows = 6\nsquare_mm = 10\n" + cameras + world,
         "must be a whole number");
  expect("[board]\ntype = \"chessboard\"\ncolumns = 6\nrows = 6\nsquare_mm = 10\n" + cameras + world,
         "looks the same after a quarter turn");
  expect("[board]\ntype = \"chessboard\"\ncolumns = 8\nrows = 6\nsquare_mm = -1\n" + cameras + world,
         "square_mm is -1");
  expect(board + cameras + "[[camera]]\nname = \"cam1\"\nframes = \"a.avi\"\n" + world, "occurs twice");
  expect(board + "[[camera]]\nname = \"cam1\"\n" + world, "frames");
  expect(board + cameras + "[world]\nworkspace_mm = [0,0,0,1,1,1]\n", "needs either board_frame");
  expect(board + cameras + "[world]\nboard_frame = 0\nworkspace_mm = [0,0,0,1,1]\n", "[x0, y0, z0");
  expect(board + cameras + "[world]\nboard_frame = 0\nworkspace_mm = [0,0,0,1,1,0]\n", "is empty");
  expect(board + cameras + "[world]\ncamera = \"cam7\"\nworkspace_mm = [0,0,0,1,1,1]\n", "'cam7'");
  expect(board + cameras + "[[known_length]]\nlength_mm = 5\ncameras = [\"cam1\"]\n" + world,
         "a known length is between two");
}

}  // namespace
}  // namespace elbowroom::control
