// A rig calibrated as a user does it, from pictures of a board whose poses are known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <tuple>
#include <utility>

#include "recon/boards/board_drawing.h"
#include "recon/rig_files/rig_file.h"
#include "tests/recon/boards/board_picture.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using Eigen::Vector3d;
using test_support::ProgramRun;
using test_support::WriteText;

constexpr int kCameras = 3;
constexpr int kSets = 14;

recon::Board MakeCharuco() {
  recon::Board board;
  board.kind = recon::BoardKind::kCharuco;
  board.columns = 7, board.rows = 5;
  board.square_mm = 30.0, board.marker_mm = 22.0;
  board.dictionary = "DICT_5X5_50";
  return board;
}

// Three cameras around a table, 700 mm away; in the world the board lies on the table in set 0.
std::vector<core::CameraCalibration> TrueCameras() {
  std::vector<core::CameraCalibration> cameras;
  for (int i = 0; i < kCameras; ++i) {
    core::CameraCalibration camera;
    camera.name = fmt::format("cam{}", i + 1);
    camera.image_width_px = 480, camera.image_height_px = 360;
    camera.camera_matrix << 520.0 + 10.0 * i, 0.0, 242.0, 0.0, 521.0 + 9.0 * i, 178.0, 0.0, 0.0, 1.0;
    camera.distortion_coefficients = {-0.2 + 0.05 * i, 0.06, 0.0005, -0.0003, 0.0};
    const double angle = -1.9 + 0.7 * i;
    camera.cam_from_world = core::CamFromWorldLookingAt(
        {105.0 + 520.0 * std::cos(angle), -75.0 + 520.0 * std::sin(angle), 470.0 + 20.0 * i},
        {105.0, -75.0, 40.0});
    cameras.push_back(camera);
  }
  return cameras;
}

// Flat on the table first, then held above it, tilted this way and that.
core::RigidTransform WorldFromBoard(int set) {
  if (set == 0) return {};
  const Vector3d tilt_deg(24.0 * std::sin(2.1 * set), 24.0 * std::cos(1.7 * set), 40.0 * std::sin(0.9 * set));
  core::RigidTransform turned = core::FromPositionAndRollPitchYaw(Vector3d::Zero(), tilt_deg);
  const Vector3d middle_in_board(105.0, -75.0, 0.0);
  const Vector3d middle_in_world(105.0 + 70.0 * std::sin(1.3 * set), -75.0 + 60.0 * std::cos(2.3 * set),
                                 60.0 + 50.0 * std::sin(0.7 * set));
  turned.translation_mm = middle_in_world - turned.rotation * middle_in_board;
  return turned;
}

// Draws all pictures once for all tests of the file.
const test_support::TemporaryFolder& Footage() {
  static const test_support::TemporaryFolder folder;
  static const bool is_drawn = [] {
    const recon::BoardDrawing drawing = recon::DrawBoard(MakeCharuco());
    for (const core::CameraCalibration& camera : TrueCameras()) {
      std::filesystem::create_directories(folder / camera.name);
      for (int set = 0; set < kSets; ++set) {
        core::CameraCalibration to_board = camera;
        to_board.cam_from_world = camera.cam_from_world * WorldFromBoard(set);
        recon::testing::PictureOptions options;
        options.seed = static_cast<unsigned>(100 * set + 1);
        const cv::Mat picture = recon::testing::PictureOf(drawing, core::CameraModel(to_board), options);
        cv::imwrite((folder / camera.name / fmt::format("{:02}.png", set)).string(), picture);
      }
    }
    return true;
  }();
  EXPECT_TRUE(is_drawn);
  return folder;
}

constexpr const char* kBoardText = R"([board]
type = "charuco"
columns = 7
rows = 5
square_mm = {}
marker_mm = {}
dictionary = "{}"
)";
constexpr const char* kWorldText = R"([world]
board_frame = 0
workspace_mm = [-50, -200, 0, 250, 50, 200]
)";

std::string CamerasText() {
  std::string text;
  for (int i = 1; i <= kCameras; ++i)
    text += fmt::format(
        "[[camera]]\nname = \"cam{0}\"\nframes = \"cam{0}/*.png\"\ndistortion_model = \"plumb_bob\"\n", i);
  return text;
}

std::string CalibrationText(double square_mm = 30.0, const std::string& dictionary = "DICT_5X5_50") {
  return fmt::format(kBoardText, square_mm, square_mm * 22.0 / 30.0, dictionary) + CamerasText() + kWorldText;
}

ProgramRun Calibrate(const std::string& text, const std::vector<std::string>& more = {}) {
  const test_support::TemporaryFolder& folder = Footage();
  WriteText(folder / "CALIB.toml", text);
  std::filesystem::remove(folder / "rig.yml");
  std::vector<std::string> arguments{"calibrate", (folder / "CALIB.toml").string(), "--out",
                                     (folder / "rig.yml").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test_support::RunProgram(test_support::ProgramFile(), arguments);
}

bool HasRig() { return std::filesystem::exists(Footage() / "rig.yml"); }

TEST(CalibrateCommand, FindsTheRigWithinItsStatedError) {
  const ProgramRun run = Calibrate(CalibrationText(), {"--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  ASSERT_EQ(json["cameras"].size(), static_cast<std::size_t>(kCameras));
  const recon::RigFile file = recon::ReadRigFile(Footage() / "rig.yml");
  const std::vector<core::CameraCalibration> truth = TrueCameras();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Vector3d true_center = truth[i].cam_from_world.Inverse().translation_mm;
    const double error_mm = (file.rig.cameras[i].center_in_world() - true_center).norm();
    const double sigma_mm = json["cameras"][i]["center_sigma_mm"];
    EXPECT_LE(error_mm, 3.0 * sigma_mm) << truth[i].name;
    EXPECT_LE(sigma_mm, 3.0) << truth[i].name;
    EXPECT_EQ(json["cameras"][i]["rejected_views"], 0);
  }
  EXPECT_LE(json["rms_px"].get<double>(), 0.2);
  EXPECT_LE(json["held_out_rms_px"].get<double>(), 0.3);
  EXPECT_LE(json["uncertainty_mm"]["median"].get<double>(), 1.0);
  EXPECT_FALSE(json["scale_checked"].get<bool>());
  EXPECT_FALSE(json["advice"].empty());
  ASSERT_TRUE(file.calibration.has_value());
  EXPECT_EQ(file.calibration->rms_px, json["rms_px"].get<double>());
  EXPECT_EQ(file.calibration->covariance.rows(), kCameras * 16);
}

TEST(CalibrateCommand, AKnownLengthTellsAWrongBoard) {
  const std::vector<core::CameraCalibration> truth = TrueCameras();
  const double length_mm =
      (truth[0].cam_from_world.Inverse().translation_mm - truth[2].cam_from_world.Inverse().translation_mm)
          .norm();
  const std::string known = fmt::format(
      "[[known_length]]\nlength_mm = {:.1f}\ntolerance_mm = 2\ncameras = [\"cam1\", \"cam3\"]\n", length_mm);
  const ProgramRun right = Calibrate(CalibrationText() + known, {"--json"});
  ASSERT_EQ(right.exit_status, 0) << right.err;
  EXPECT_TRUE(nlohmann::json::parse(right.out)["scale_checked"].get<bool>());
  // Squares that are 4 % larger than stated: the same error of reprojection, but another length.
  const ProgramRun wrong = Calibrate(CalibrationText(30.0 / 1.04) + known, {"--json"});
  ASSERT_EQ(wrong.exit_status, 0) << wrong.err;
  const auto json = nlohmann::json::parse(wrong.out), right_json = nlohmann::json::parse(right.out);
  EXPECT_FALSE(json["scale_checked"].get<bool>());
  EXPECT_FALSE(json["warnings"].empty());
  EXPECT_NEAR(json["rms_px"].get<double>(), right_json["rms_px"].get<double>(), 1e-3);
}

TEST(CalibrateCommand, BadInputIsOneLineAndLeavesNoRig) {
  const auto expect = [](const std::string& text, std::string_view part) {
    const ProgramRun run = Calibrate(text);
    EXPECT_EQ(run.exit_status, 1) << part;
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(HasRig()) << part;
  };
  expect(CalibrationText(30.0, "DICT_ARUCO_ORIGINAL"), "no camera shows the board");
  expect(CalibrationText(30.0, "DICT_9X9"), "DICT_9X9");
  expect(fmt::format(kBoardText, 30.0, 22.0, "DICT_5X5_50") +
             "[[camera]]\nname = \"cam1\"\nframes = \"cam1/*.jpg\"\n" + kWorldText,
         "no image fits");
}

// Only these cameras, with this text for each one's frames.
std::string Only(const std::vector<std::pair<std::string, std::string>>& frames_of,
                 const std::string& more = "") {
  std::string text = fmt::format(kBoardText, 30.0, 22.0, "DICT_5X5_50");
  for (const auto& [name, frames] : frames_of)
    text += fmt::format("[[camera]]\nname = \"{}\"\nframes = \"{}\"\ndistortion_model = \"plumb_bob\"\n{}",
                        name, frames, more);
  return text + kWorldText;
}

void CopyPictures(const std::string& from, const std::string& to, int first, int end, double scale = 1.0) {
  const std::filesystem::path folder = Footage() / to;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  for (int set = first; set < end; ++set) {
    cv::Mat picture = cv::imread((Footage() / from / fmt::format("{:02}.png", set)).string());
    if (scale != 1.0) cv::resize(picture, picture, {}, scale, scale);
    cv::imwrite((folder / fmt::format("{:02}.png", set)).string(), picture);
  }
}

TEST(CalibrateCommand, WhatTheFootageLacksIsOneLineWithTheCamerasName) {
  const auto expect = [](const std::string& text, const std::vector<std::string>& parts) {
    const ProgramRun run = Calibrate(text);
    EXPECT_EQ(run.exit_status, 1) << parts.front();
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    for (const std::string& part : parts) EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    EXPECT_FALSE(HasRig()) << parts.front();
  };
  // No picture of the second camera shows the board.
  std::filesystem::create_directories(Footage() / "blank");
  for (int set = 0; set < kSets; ++set)
    cv::imwrite((Footage() / "blank" / fmt::format("{:02}.png", set)).string(),
                cv::Mat(360, 480, CV_8UC3, cv::Scalar(90, 90, 90)));
  expect(Only({{"cam1", "cam1/*.png"}, {"cam2", "blank/*.png"}}), {"cam2", "board"});
  // No two cameras see it at once: one sees the first half, the other the second.
  for (int set = 0; set < kSets; ++set) {
    for (const auto& [from, to, shows] :
         {std::tuple("cam1", "early", set < kSets / 2), std::tuple("cam2", "late", set >= kSets / 2)}) {
      std::filesystem::create_directories(Footage() / to);
      const std::string name = fmt::format("{:02}.png", set);
      std::filesystem::copy_file(Footage() / (shows ? from : "blank") / name, Footage() / to / name,
                                 std::filesystem::copy_options::overwrite_existing);
    }
  }
  expect(Only({{"cam1", "early/*.png"}, {"cam2", "late/*.png"}}), {"cam1", "cam2"});
  // Pictures of two sizes, in one camera and between its photos and its frames.
  CopyPictures("cam1", "sizes", 0, kSets);
  cv::Mat small = cv::imread((Footage() / "sizes" / "05.png").string());
  cv::resize(small, small, {}, 0.5, 0.5);
  cv::imwrite((Footage() / "sizes" / "05.png").string(), small);
  expect(Only({{"cam1", "sizes/*.png"}, {"cam2", "cam2/*.png"}}), {"cam1", "frame 5 of", "240 x 180 px"});
  CopyPictures("cam1", "photos", 0, 5, 0.5);
  expect(Only({{"cam1", "cam1/*.png"}}, "intrinsics = \"photos/*.png\"\n"),
         {"cam1", "240 x 180", "480 x 360"});
  // Stamps that go backwards.
  std::string stamps = "frame,time_s\n";
  for (int set = 0; set < kSets; ++set) stamps += fmt::format("{},{}\n", set, set == 6 ? 0.01 : 0.1 * set);
  WriteText(Footage() / "stamps.csv", stamps);
  expect(Only({{"cam1", "cam1/*.png"}, {"cam2", "cam2/*.png"}}, "timestamps = \"stamps.csv\"\n"),
         {"cam1", "stamps.csv", "line 8", "goes back"});
}

// Writes the pictures of a camera as a video: Motion JPEG, or MPEG-4 in a container whose table is at its
// end.
std::filesystem::path VideoOf(const std::string& camera, const std::string& extension = ".avi") {
  const std::filesystem::path path = Footage() / (camera + extension);
  const int codec = extension == ".avi" ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G')
                                        : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
  cv::VideoWriter writer(path.string(), codec, 10.0, {480, 360});
  writer.set(cv::VIDEOWRITER_PROP_QUALITY, 98);
  for (int set = 0; set < kSets; ++set)
    writer.write(cv::imread((Footage() / camera / fmt::format("{:02}.png", set)).string()));
  writer.release();
  return path;
}

TEST(CalibrateCommand, AVideoThatIsCutShortIsNamed) {
  for (int i = 1; i <= kCameras; ++i) (void)VideoOf(fmt::format("cam{}", i));
  const std::string text = Only({{"cam1", "cam1.avi"}, {"cam2", "cam2.avi"}, {"cam3", "cam3.avi"}});
  const ProgramRun whole = Calibrate(text, {"--json"});
  ASSERT_EQ(whole.exit_status, 0) << whole.err;
  EXPECT_TRUE(nlohmann::json::parse(whole.out)["warnings"].empty()) << whole.out;
  // The container promises more than there is.
  recon::testing::PromiseFrames(Footage() / "cam2.avi", kSets + 5);
  const ProgramRun promised = Calibrate(text, {"--json"});
  ASSERT_EQ(promised.exit_status, 0) << promised.err;
  EXPECT_NE(promised.out.find("camera 'cam2'"), std::string::npos) << promised.out;
  // The file breaks off.
  for (const std::string extension : {".avi", ".mp4"}) {
    const std::string name = "cut" + extension;
    recon::testing::CutFile(VideoOf("cam2", extension), Footage() / name, 0.6);
    const ProgramRun cut = Calibrate(Only({{"cam1", "cam1.avi"}, {"cam2", name}}));
    EXPECT_EQ(cut.exit_status, 1);
    EXPECT_EQ(std::count(cut.err.begin(), cut.err.end(), '\n'), 1) << cut.err;
    EXPECT_NE(cut.err.find(name), std::string::npos) << cut.err;
    EXPECT_EQ(cut.err.find("internal error"), std::string::npos) << cut.err;
    EXPECT_FALSE(HasRig());
  }
}

TEST(CalibrateCommand, ARigFileNamesTheTrialsPictures) {
  std::string text = CalibrationText();
  text.insert(text.find("distortion_model"),
              "trial_frames = \"cam1/%02d.png\"\nbackground = \"blank.png\"\n");
  const ProgramRun run = Calibrate(text);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const recon::RigFile file = recon::ReadRigFile(Footage() / "rig.yml");
  EXPECT_EQ(file.sources[0].frames, (Footage() / "cam1/%02d.png").string());
  EXPECT_EQ(file.sources[0].background, (Footage() / "blank.png").string());
  EXPECT_EQ(file.sources[1].frames, "");
}

TEST(CalibrateCommand, ThreeViewsAreWarnedOfByName) {
  CopyPictures("cam1", "few1", 0, 3);
  CopyPictures("cam2", "few2", 0, 3);
  const ProgramRun run = Calibrate(Only({{"cam1", "few1/*.png"}, {"cam2", "few2/*.png"}}), {"--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.out.find("camera 'cam1': only 3 of its views are used"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("camera 'cam2': only 3 of its views are used"), std::string::npos) << run.out;
}

TEST(CalibrateCommand, FewViewsAreRefusedWithTheCamerasName) {
  const std::string text = fmt::format(kBoardText, 30.0, 22.0, "DICT_5X5_50") +
                           "[[camera]]\nname = \"cam1\"\nframes = \"cam1/00.png\"\n"
                           "[[camera]]\nname = \"cam2\"\nframes = \"cam2/00.png\"\n" +
                           kWorldText;
  const ProgramRun run = Calibrate(text);
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("cam1"), std::string::npos) << run.err;
  EXPECT_FALSE(HasRig());
}

// As anipose writes it, or would if its poses were the cameras' own: in cm, of a world that isn't the board.
std::string AniposeText(bool is_world_from_cam) {
  const core::RigidTransform board_from_world =
      core::FromPositionAndRollPitchYaw({150.0, -80.0, 40.0}, {20.0, -35.0, 70.0});
  std::string text;
  for (const core::CameraCalibration& camera : TrueCameras()) {
    core::RigidTransform stated = camera.cam_from_world * board_from_world;
    if (is_world_from_cam) stated = stated.Inverse();
    const Eigen::AngleAxisd turn(stated.rotation);
    const Vector3d vector = turn.angle() * turn.axis(), t_cm = 0.1 * stated.translation_mm;
    const Eigen::Matrix3d& k = camera.camera_matrix;
    const std::vector<double>& d = camera.distortion_coefficients;
    text += fmt::format(
        "[cam_{0}]\nname = \"{0}\"\nsize = [480, 360]\nmatrix = [[{1}, 0.0, {2}], [0.0, {3}, {4}], [0.0, "
        "0.0, 1.0]]\n"
        "distortions = [{5}, {6}, {7}, {8}, 0.0]\nrotation = [{9}, {10}, {11}]\ntranslation = [{12}, {13}, "
        "{14}]\n",
        camera.name, k(0, 0), k(0, 2), k(1, 1), k(1, 2), d[0], d[1], d[2], d[3], vector.x(), vector.y(),
        vector.z(), t_cm.x(), t_cm.y(), t_cm.z());
  }
  return text + "[metadata]\nadjusted = false\n";
}

ProgramRun ImportRig(const std::string& rig, const std::vector<std::string>& more) {
  const test_support::TemporaryFolder& folder = Footage();
  WriteText(folder / "calibration.toml", rig);
  WriteText(folder / "CALIB.toml", CalibrationText());
  std::filesystem::remove(folder / "rig.yml");
  std::vector<std::string> arguments{"rig", "import", (folder / "calibration.toml").string(), "--out",
                                     (folder / "rig.yml").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test_support::RunProgram(test_support::ProgramFile(), arguments);
}

TEST(RigImportCommand, TheBoardTellsPosesUnitAndWorld) {
  constexpr double kWorldMm =
      3.0;  // of one board in three pictures, as FindsTheRigWithinItsStatedError has it
  for (const bool is_world_from_cam : {false, true}) {
    const ProgramRun run =
        ImportRig(AniposeText(is_world_from_cam), {"--json", "--check", (Footage() / "CALIB.toml").string()});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["format"], "anipose");
    EXPECT_EQ(json["pose"], is_world_from_cam ? "world_from_cam" : "cam_from_world");
    EXPECT_EQ(json["axes"], "opencv");
    EXPECT_EQ(json["unit"], "cm");
    EXPECT_LE(json["error_px"].get<double>(), 0.3);
    EXPECT_EQ(json["tried"].size(), 4U);
    EXPECT_EQ(json["warnings"].size(), is_world_from_cam ? 1U : 0U) << json["warnings"];
    const recon::RigFile file = recon::ReadRigFile(Footage() / "rig.yml");
    const std::vector<core::CameraCalibration> truth = TrueCameras();
    ASSERT_EQ(file.rig.cameras.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i)
      EXPECT_LE(
          (file.rig.cameras[i].center_in_world() - truth[i].cam_from_world.Inverse().translation_mm).norm(),
          kWorldMm);
    ASSERT_TRUE(file.calibration.has_value());
    EXPECT_EQ(file.calibration->covariance.size(), 0);
  }
}

TEST(RigImportCommand, WithoutACheckItSaysSo) {
  const ProgramRun run = ImportRig(AniposeText(false), {"--unit", "cm", "--up", "-y", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_FALSE(json["checked"].get<bool>());
  EXPECT_NE(json["warnings"].dump().find("nothing is checked"), std::string::npos);
  const recon::RigFile file = recon::ReadRigFile(Footage() / "rig.yml");
  EXPECT_FALSE(file.rig.workspace_mm.isEmpty());
  // What was along -y in the file is along z now: the board's place in the file, seen by the first camera.
  const core::RigidTransform file_from_cam =
      (TrueCameras()[0].cam_from_world *
       core::FromPositionAndRollPitchYaw({150.0, -80.0, 40.0}, {20.0, -35.0, 70.0}))
          .Inverse();
  EXPECT_NEAR(file.rig.cameras[0].center_in_world().z(), -file_from_cam.translation_mm.y(), 1e-3);
}

TEST(RigImportCommand, BadInputIsOneLineAndLeavesNoRig) {
  const std::string check = (Footage() / "CALIB.toml").string();
  const auto expect = [](const ProgramRun& run, std::string_view part) {
    EXPECT_EQ(run.exit_status, 1) << part;
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(HasRig()) << part;
  };
  expect(ImportRig(AniposeText(false), {}), "don't say their unit");
  expect(ImportRig("[cam_0]\nsize = 5\nmatrix = 1\n", {"--unit", "mm"}), "[cam_0]: key 'size'");
  std::string exchanged = AniposeText(false);
  exchanged.replace(exchanged.find("name = \"cam1\""), 13, "name = \"cam9\"");
  expect(ImportRig(exchanged, {"--check", check}), "no camera 'cam1'");
  exchanged.replace(exchanged.find("name = \"cam2\""), 13, "name = \"cam1\"");
  exchanged.replace(exchanged.find("name = \"cam9\""), 13, "name = \"cam2\"");
  expect(ImportRig(exchanged, {"--check", check}), "the board refutes the poses");
  expect(ImportRig(AniposeText(true), {"--check", check, "--pose", "cam_from_world"}), "refutes");
  EXPECT_EQ(ImportRig(AniposeText(false), {"--check", check, "--up", "y"}).exit_status, 2);
}

}  // namespace
}  // namespace elbowroom
