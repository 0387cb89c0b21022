// The user guide's chapter "Your first live verdict" as it is written, with the first rig's pictures served
// by GigE Vision cameras.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "recon/rig_files/rig_file.h"
#include "tests/examples/first_rig.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::examples {
namespace {

using recon::testing::ServedRig;
using test_support::ReadText;
using test_support::WriteText;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

constexpr int kCameras = 3;
constexpr double kRateHz = 10.0;
const fs::path kPictures = test_support::SourceFolder() / "docs/examples/first_rig";

const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new recon::testing::OwnNetwork(kCameras));

// What all cameras see in the pictures of that name.
recon::FrameSet SetOf(const std::string& picture) {
  recon::FrameSet set;
  for (int camera = 1; camera <= kCameras; ++camera)
    set.cameras.emplace_back().image_bgr =
        cv::imread((kPictures / fmt::format("cam{}", camera) / picture).string());
  return set;
}

class FirstLiveVerdict : public ::testing::Test {
 protected:
  nlohmann::json Run(std::vector<std::string> arguments) const {
    arguments.emplace_back("--json");
    const test_support::ProgramRun run =
        test_support::RunProgram(test_support::ProgramFile(), arguments, {.working_folder = folder_.path()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }

  // The board lies still, for as long as it takes to start recording; then it is carried about.
  static std::vector<recon::FrameSet> BoardSets() {
    constexpr int kStill = 50, kAtEachPlace = 3;
    std::vector<recon::FrameSet> sets(kStill, SetOf("board_00.jpg"));
    for (int place = 1; place < kBoardSets; ++place)
      sets.insert(sets.end(), kAtEachPlace, SetOf(fmt::format("board_{:02}.jpg", place)));
    return sets;
  }

  static std::vector<recon::FrameSet> HandSets() {
    std::vector<recon::FrameSet> sets;
    for (int frame = kRodFrames; frame < kRodFrames + kHandFrames; ++frame)
      sets.push_back(SetOf(fmt::format("trial_{:02}.jpg", frame)));
    return sets;
  }

  // What the reader changes in cameras.yml for these cameras: the pixels are to come as they are.
  void SetPixelFormat() const {
    std::string text = ReadText(folder_ / "cameras.yml");
    const std::string rate = "rate_hz: 10.0\n", with_format = rate + "         pixel_format: \"RGB8\"\n";
    for (std::size_t at = text.find(rate); at != std::string::npos;
         at = text.find(rate, at + with_format.size()))
      text.replace(at, rate.size(), with_format);
    WriteText(folder_ / "cameras.yml", text);
  }

  // The example's CALIB.toml with the recorded pictures.
  void WriteCalib() const {
    std::string text = "live = \"cameras.yml\"\n" + ReadText(kPictures / "CALIB.toml");
    for (int camera = 1; camera <= kCameras; ++camera) {
      const std::string name = fmt::format("cam{}", camera);
      const auto replace = [&](const std::string& old, const std::string& by) {
        const std::size_t begin = text.find(old), end = text.find('\n', begin);
        ASSERT_NE(begin, std::string::npos) << old;
        text.replace(begin, end - begin, by);
      };
      replace(fmt::format("frames = \"{}/board", name),
              fmt::format("frames = \"board/{0}/video.avi\"\ntimestamps = \"board/{0}/stamps.csv\"", name));
      replace(fmt::format("trial_frames = \"{}/", name), "");
      replace(fmt::format("background = \"{}/", name), "");
    }
    WriteText(folder_ / "CALIB.toml", text);
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(FirstLiveVerdict, ComesAsTheUserGuideSays) {
  {
    const ServedRig board(BoardSets(), kRateHz);
    const nlohmann::json list =
        Run({"cameras", "list", "--out", "cameras.yml", "--size", "480x360", "--rate", "10"});
    ASSERT_FALSE(list.is_null());
    ASSERT_EQ(list["cameras"].size(), static_cast<std::size_t>(kCameras)) << list;
    const recon::RigFile listed = recon::ReadRigFile(folder_ / "cameras.yml", recon::RigUse::kPictures);
    EXPECT_FALSE(listed.is_calibrated);
    SetPixelFormat();
    ASSERT_THAT(ReadText(folder_ / "cameras.yml"), HasSubstr("RGB8"));
    const nlohmann::json check =
        Run({"cameras", "check", "cameras.yml", "--seconds", "1", "--out", "preflight"});
    ASSERT_FALSE(check.is_null());
    EXPECT_EQ(check["cameras"].size(), static_cast<std::size_t>(kCameras));
    const std::string page = ReadText(folder_ / "preflight" / "preflight.html");
    EXPECT_THAT(page, HasSubstr("Not ready for a trial."));
    EXPECT_THAT(page, HasSubstr("aren&#39;t calibrated yet"));
  }
  {
    const ServedRig board(BoardSets(), kRateHz);
    const nlohmann::json recorded =
        Run({"cameras", "record", "cameras.yml", "--out", "board", "--seconds", "11"});
    ASSERT_FALSE(recorded.is_null());
  }
  WriteCalib();
  const nlohmann::json calibrated =
      Run({"calibrate", "CALIB.toml", "--out", "rig.yml", "--report", "calibration"});
  ASSERT_FALSE(calibrated.is_null());
  EXPECT_TRUE(calibrated["scale_checked"]);
  EXPECT_LE(calibrated["held_out_rms_px"], 0.5);
  const recon::RigFile rig = recon::ReadRigFile(folder_ / "rig.yml");
  EXPECT_EQ(rig.sources[0].capture.rate_hz, kRateHz);
  EXPECT_THAT(rig.sources[0].frames, HasSubstr("gige:"));
  {
    const ServedRig empty({SetOf("empty.jpg")}, kRateHz);
    ASSERT_FALSE(Run({"background", "rig.yml", "--out", "empty", "--seconds", "2"}).is_null());
    ASSERT_FALSE(
        Run({"cameras", "check", "empty/RIG.yml", "--seconds", "2", "--out", "preflight"}).is_null());
    const std::string page = ReadText(folder_ / "preflight" / "preflight.html");
    EXPECT_THAT(page, Not(HasSubstr("Not ready for a trial.")));
    std::size_t pictures = 0;
    for (std::size_t at = page.find("src='data:image/png"); at != std::string::npos;
         at = page.find("src='data:image/png", at + 1))
      ++pictures;
    EXPECT_EQ(pictures, static_cast<std::size_t>(kCameras));
  }
  {
    const ServedRig hand(HandSets(), kRateHz);
    fs::copy(kPictures / "layout.toml", folder_.path());
    fs::copy(kPictures / "bracket.stl", folder_.path());
    std::string trial = ReadText(kPictures / "trial.toml");
    trial.replace(trial.find("\"rig.yml\""), 9, "\"empty/RIG.yml\"");
    WriteText(folder_ / "trial.toml", trial);
    const nlohmann::json tried =
        Run({"trial", "run", "trial.toml", "--session", "first.db", "--headless", "--frames", "0:24"});
    ASSERT_FALSE(tried.is_null());
    EXPECT_EQ(tried["frames"], 24);
    EXPECT_GT(tried["parts"][0]["frames_in_contact"], 0) << tried;
    EXPECT_LT(tried["parts"][0]["frames_in_contact"], 20) << tried;
  }
}

// A rig that isn't calibrated yet is good for pictures alone.
TEST_F(FirstLiveVerdict, BeforeTheCalibrationThereIsNoTrial) {
  ASSERT_FALSE(Run({"cameras", "list", "--out", "cameras.yml", "--add", "rtsp://nowhere/1"}).is_null());
  fs::copy(kPictures / "layout.toml", folder_.path());
  fs::copy(kPictures / "bracket.stl", folder_.path());
  WriteText(folder_ / "trial.toml", "rig = \"cameras.yml\"\nlayout = \"layout.toml\"\n");
  const test_support::ProgramRun run = test_support::RunProgram(
      test_support::ProgramFile(), {"trial", "run", "trial.toml", "--session", "first.db", "--headless"},
      {.working_folder = folder_.path()});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_THAT(run.err, HasSubstr("camera 'cam1': not calibrated yet"));
}

}  // namespace
}  // namespace elbowroom::examples
