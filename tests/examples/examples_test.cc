// The sample files of the documentation run as the user guide says, and measure what is true of them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "recon/rig_files/rig_file.h"
#include "sessions/session_reader.h"
#include "tests/examples/first_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::examples {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kSource = test_support::SourceFolder() / "docs/examples/first_rig";

// A copy, so that nothing is written beside the documents.
class FirstRig : public testing::Test {
 protected:
  FirstRig() { fs::copy(kSource, folder_.path(), fs::copy_options::recursive); }

  [[nodiscard]] nlohmann::json Run(const std::vector<std::string>& arguments) const {
    const test_support::ProgramRun run =
        test_support::RunProgram(test_support::ProgramFile(), arguments, {.working_folder = folder_.path()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(FirstRig, IsCalibratedGaugedTriedAndReported) {
  const auto calibrated =
      Run({"calibrate", "CALIB.toml", "--out", "rig.yml", "--report", "calibration", "--json"});
  ASSERT_FALSE(calibrated.is_null());
  EXPECT_TRUE(calibrated["scale_checked"]);
  EXPECT_LE(calibrated["held_out_rms_px"], 0.5);
  const recon::RigFile rig = recon::ReadRigFile(folder_ / "rig.yml");
  const std::vector<core::CameraCalibration> truth = FirstCameras();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Vector3d center = truth[i].cam_from_world.Inverse().translation_mm;
    EXPECT_LE((rig.rig.cameras[i].center_in_world() - center).norm(),
              3.0 * calibrated["cameras"][i]["center_sigma_mm"].get<double>());
  }
  EXPECT_TRUE(fs::exists(folder_ / "calibration" / "report.html"));

  const auto gauged = Run({"gauge", "rig.yml", "--frames", fmt::format("0:{}", kRodFrames), "--rod",
                           fmt::format("{}", kRodDiameterMm), "--length", fmt::format("{}", kRodLengthMm),
                           "--save", "--json"});
  ASSERT_FALSE(gauged.is_null());
  EXPECT_EQ(gauged["places"], kRodFrames);
  EXPECT_TRUE(gauged["passed"]) << gauged.dump();
  const auto covered = Run({"coverage", "rig.yml", "--layout", "layout.toml", "--out", "coverage", "--json"});
  ASSERT_FALSE(covered.is_null());
  EXPECT_GE(covered["cameras_seeing"]["median"], 2);

  const auto tried = Run({"trial", "run", "trial.toml", "--session", "first.db", "--headless", "--frames",
                          fmt::format("{}:{}", kRodFrames, kRodFrames + kHandFrames), "--json"});
  ASSERT_FALSE(tried.is_null());
  EXPECT_EQ(tried["frames"], kHandFrames);
  EXPECT_EQ(tried["episodes"].size(), 1U);
  EXPECT_GT(tried["parts"][0]["largest_uncertainty_mm"], 0.0);
  const auto reported = Run({"report", "first.db", "--out", "report", "--json"});
  ASSERT_FALSE(reported.is_null());
  const std::string page = test_support::ReadText(folder_ / "report" / "report.html");
  EXPECT_THAT(page, HasSubstr("1 touch"));
  EXPECT_THAT(page, HasSubstr("What a verdict allows for is computed"));
  EXPECT_THAT(page, HasSubstr("<b>passed</b>"));
}

// The chapter's last step, with two of its twelve participants.
TEST(FirstStudy, TrialsOfThePlanAreAStudy) {
  const test_support::TemporaryFolder folder;
  fs::copy(kSource.parent_path(), folder.path(), fs::copy_options::recursive);
  const auto run = [&](std::vector<std::string> arguments) {
    const auto ran =
        test_support::RunProgram(test_support::ProgramFile(), arguments, {.working_folder = folder.path()});
    EXPECT_EQ(ran.exit_status, 0) << arguments[0] << ": " << ran.err;
    return ran.out;
  };
  run({"calibrate", "first_rig/CALIB.toml", "--out", "first_rig/rig.yml"});
  run({"plan", "study/STUDY.toml", "--trials", "trials"});
  for (const std::string participant : {"P01", "P02"})
    run({"trial", "run", "trials/" + participant + "-1.toml", "--session", participant + ".db", "--headless",
         "--frames", fmt::format("{}:{}", kRodFrames, kRodFrames + kHandFrames)});
  const auto study = nlohmann::json::parse(run({"study", "P01.db", "P02.db", "--out", "report", "--json"}));
  EXPECT_EQ(study["spacing"], "bracket_gap");
  ASSERT_EQ(study["rows"].size(), 2U);
  // Below the bracket, which is a cube of 40 mm around (105, -20), above the plate, whose top is at 0.
  const std::optional<double> highest_mm =
      HighestOfHandMm({Eigen::Vector2d(85.0, -40.0), Eigen::Vector2d(125.0, 0.0)});
  ASSERT_TRUE(highest_mm.has_value());
  constexpr double kLostMm = 1.0, kHullExcessMm = 5.0;
  for (const auto& row : study["rows"]) {
    EXPECT_GE(row["needed_mm"], *highest_mm - kLostMm);
    EXPECT_LE(row["needed_mm"], *highest_mm + kHullExcessMm);
  }
  EXPECT_TRUE(fs::exists(folder / "report" / "report.html"));
}

// The pictures that ship are those that the generator draws, up to the JPEG coder.
TEST_F(FirstRig, ShipsThePicturesThatAreDrawn) {
  const test_support::TemporaryFolder drawn;
  const std::vector<std::string> names = {"cam1/board_03.jpg", "cam2/empty.jpg", "cam3/trial_14.jpg"};
  DrawFirstRig(drawn.path(), names);
  for (const std::string& name : names) {
    const cv::Mat shipped = cv::imread((folder_ / name).string()),
                  fresh = cv::imread((drawn / name).string());
    ASSERT_EQ(shipped.size(), fresh.size()) << name;
    EXPECT_LE(cv::norm(shipped, fresh, cv::NORM_L1) / static_cast<double>(shipped.total() * 3), 1.0) << name;
  }
}

}  // namespace
}  // namespace elbowroom::examples
