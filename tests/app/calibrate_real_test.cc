// Rigs calibrated from real pictures, as a user does it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "recon/rig_files/rig_file.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

const std::filesystem::path kData = test_support::SharedDataFolder();

class RealPictures : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kData / "calibration"))
      GTEST_SKIP() << "NOT TESTED: there are no real pictures at " << kData;
  }

  [[nodiscard]] nlohmann::json Calibrate(const std::filesystem::path& calibration) const {
    const auto run =
        test_support::RunProgram(test_support::ProgramFile(),
                                 {"calibrate", calibration.string(), "--out", (folder_ / "rig.yml").string(),
                                  "--report", (folder_ / "report").string(), "--json"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }

  test_support::TemporaryFolder folder_;
};

// The set's own session gives its cameras errors of 0.33 to 0.54 px, and no offsets.
TEST_F(RealPictures, OfWebcamsWithoutACommonClockGiveTheirOffsets) {
  const nlohmann::json json = Calibrate(kData / "calibration/webcams/CALIB_known.toml");
  ASSERT_FALSE(json.is_null());
  EXPECT_LE(json["rms_px"].get<double>(), 0.5);
  EXPECT_LE(json["held_out_rms_px"].get<double>(), 0.6);
  EXPECT_LE(json["rigidity_rms_mm"].get<double>(), 1.0);
  constexpr double kFrame_s = 1.0 / 6.0;
  for (std::size_t i = 1; i < 4; ++i) {
    const double offset_s = json["cameras"][i]["time_offset_s"];
    const double sigma_s = json["cameras"][i]["time_offset_sigma_s"];
    EXPECT_LE(std::abs(offset_s), kFrame_s);
    EXPECT_GT(std::abs(offset_s), 5.0 * sigma_s) << "they are really apart";
    EXPECT_GT(json["cameras"][i]["views"].get<int>(), 3 * json["cameras"][i]["rejected_views"].get<int>());
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report/report.html"));
}

// OpenCV's own fit of these pictures: 0.41 and 0.46 px, focal lengths 536.1 and 542.4, a baseline of 83.6 mm.
TEST_F(RealPictures, OfAStereoPairConfirmItsBaseline) {
  const std::filesystem::path pictures = std::filesystem::absolute(kData / "calibration/chessboard");
  const std::string camera = "[[camera]]\nname = \"{1}\"\nframes = \"{0}/{1}*.jpg\"\n";
  test_support::WriteText(
      folder_ / "CALIB.toml",
      "[board]\ntype = \"chessboard\"\ncolumns = 9\nrows = 6\nsquare_mm = 25.0\n" +
          fmt::format(fmt::runtime(camera), pictures.string(), "left") +
          fmt::format(fmt::runtime(camera), pictures.string(), "right") +
          "[[known_length]]\ncameras = [\"left\", \"right\"]\nlength_mm = 83.6\ntolerance_mm = 0.5\n"
          "[world]\ncamera = \"left\"\nworkspace_mm = [-200, -200, 200, 200, 200, 600]\n");
  const nlohmann::json json = Calibrate(folder_ / "CALIB.toml");
  ASSERT_FALSE(json.is_null());
  EXPECT_LE(json["rms_px"].get<double>(), 0.3);
  EXPECT_TRUE(json["scale_checked"].get<bool>()) << json["known_lengths"];
  const recon::RigFile rig = recon::ReadRigFile(folder_ / "rig.yml");
  EXPECT_NEAR(rig.rig.cameras[0].calibration().camera_matrix(0, 0), 536.1, 6.0);
  EXPECT_NEAR(rig.rig.cameras[1].calibration().camera_matrix(0, 0), 542.4, 6.0);
}

// One view of a board at a grazing angle joins them; it looks the same after half a turn, so a warning must
// say so.
TEST_F(RealPictures, OfABoardOnTheFloorJoinFourCameras) {
  const nlohmann::json json = Calibrate(kData / "four_cameras/CALIB.toml");
  ASSERT_FALSE(json.is_null());
  EXPECT_LE(json["rms_px"].get<double>(), 0.25);
  EXPECT_NE(json["warnings"].dump().find("looks the same after half a turn"), std::string::npos);
  const recon::RigFile found = recon::ReadRigFile(folder_ / "rig.yml");
  const recon::RigFile given = recon::ReadRigFile(kData / "four_cameras/rig.yml");
  // The given poses are 1 to 2 px off on the board's corners, so they can only tell that nothing is mixed up.
  constexpr double kGivenIsOff_mm = 250.0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LE((found.rig.cameras[i].center_in_world() - given.rig.cameras[i].center_in_world()).norm(),
              kGivenIsOff_mm);
  }
}

// Caliscope's own result of the webcams' session; its cameras have no offsets, so moving boards are off.
TEST_F(RealPictures, AnImportedRigOfCaliscopeIsAsTheBoardHasIt) {
  const auto run =
      test_support::RunProgram(test_support::ProgramFile(),
                               {"rig", "import", (kData / "calibration/webcams/camera_array.toml").string(),
                                "--out", (folder_ / "rig.yml").string(), "--check",
                                (kData / "calibration/webcams/CALIB_known.toml").string(), "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["format"], "caliscope");
  EXPECT_EQ(json["pose"], "cam_from_world");
  EXPECT_EQ(json["axes"], "opencv");
  EXPECT_EQ(json["unit"], "m");
  EXPECT_LE(json["error_px"].get<double>(), 1.5);
  EXPECT_NEAR(json["scale_of_board"].get<double>(), 1.0, 0.01);
  EXPECT_GE(json["tried"][1]["error_px"].get<double>(), 50.0);
}

// The rig that comes with the four cameras, as 3 x 4 matrices of the wrong sign, in metres.
TEST_F(RealPictures, MatricesOfFourCamerasAreTheRigThatTheyAreOf) {
  const recon::RigFile given = recon::ReadRigFile(kData / "four_cameras/rig.yml");
  std::string matrices, cameras;
  const std::filesystem::path footage = std::filesystem::absolute(kData / "four_cameras");
  for (const core::CameraModel& camera : given.rig.cameras) {
    Eigen::Matrix<double, 3, 4> p;
    p << camera.cam_from_world().rotation, 1e-3 * camera.cam_from_world().translation_mm;
    p = -2.5 * camera.calibration().camera_matrix * p;
    matrices += camera.name() + "\n";
    for (int row = 0; row < 3; ++row)
      matrices +=
          fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", p(row, 0), p(row, 1), p(row, 2), p(row, 3));
    cameras += fmt::format(
        "[[camera]]\nname = \"{0}\"\nframes = \"{1}/{0}/checkerboard.avi\"\nknown = "
        "\"{1}/rig.yml\"\n",
        camera.name(), footage.string());
  }
  test_support::WriteText(folder_ / "matrices.txt", matrices);
  test_support::WriteText(
      folder_ / "CALIB.toml",
      "[board]\ntype = \"chessboard\"\ncolumns = 8\nrows = 6\nsquare_mm = 115.0\n" + cameras +
          "[world]\nboard_frame = 0\nworkspace_mm = [-1500, -3000, 0, 3500, 2500, 2200]\n");
  const auto run = test_support::RunProgram(
      test_support::ProgramFile(),
      {"rig", "import", (folder_ / "matrices.txt").string(), "--out", (folder_ / "rig.yml").string(),
       "--check", (folder_ / "CALIB.toml").string(), "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["axes"], "opencv");
  EXPECT_EQ(json["unit"], "m");
  EXPECT_LE(json["error_px"].get<double>(),
            2.1);  // the given rig's worst camera has 2.02 px on these corners
  const recon::RigFile found = recon::ReadRigFile(folder_ / "rig.yml");
  constexpr double kRoundingMm = 1e-6;
  const auto apart = [](const core::Rig& rig, std::size_t i) {
    return (rig.cameras[i].center_in_world() - rig.cameras[0].center_in_world()).norm();
  };
  for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(apart(found.rig, i), apart(given.rig, i), kRoundingMm);
}

}  // namespace
}  // namespace elbowroom
