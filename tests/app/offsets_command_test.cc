// elbowroom cameras offsets, with footage of hands and of a light that blinks.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "recon/rig_files/rig_file.h"
#include "tests/app/hand_footage.h"
#include "tests/recon/consistency/blinking_light.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;
using test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ProgramRun Offsets(const std::filesystem::path& rig, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"cameras", "offsets", rig.string(), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test_support::RunProgram(test_support::ProgramFile(), arguments);
}

// Offsets against the first camera's, each within `most_s` and five sigmas of the truth.
void ExpectOffsets(const nlohmann::json& found, const std::vector<double>& true_s, double most_s) {
  constexpr double kSigmas = 5.0;
  ASSERT_EQ(found["cameras"].size(), true_s.size());
  EXPECT_EQ(found["cameras"][0]["change_s"], 0.0);
  for (std::size_t i = 1; i < true_s.size(); ++i) {
    const double error_s = found["cameras"][i]["change_s"].get<double>() - (true_s[i] - true_s[0]);
    const double sigma_s = found["cameras"][i]["time_offset_sigma_s"];
    EXPECT_GT(sigma_s, 0.0);
    EXPECT_LT(std::abs(error_s), std::min(most_s, kSigmas * sigma_s)) << "camera " << i;
  }
}

TEST(OffsetsCommand, FromHandsAndThenNothingIsLeft) {
  const std::vector<double> true_s = {0.0, 0.011, -0.008, 0.021};
  constexpr double kMostS = 0.003;
  const TemporaryFolder folder;
  const std::filesystem::path rig = test_support::WriteHandFootage(folder.path(), {.offset_s = true_s});
  const ProgramRun run = Offsets(rig, {"--out", (folder / "late.yml").string()});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json found = nlohmann::json::parse(run.out);
  ExpectOffsets(found, true_s, kMostS);
  EXPECT_EQ(found["by"], "silhouettes");
  EXPECT_THAT(found["warnings"], IsEmpty());

  const recon::RigFile written = recon::ReadRigFile(folder / "late.yml");
  for (std::size_t i = 0; i < true_s.size(); ++i)
    EXPECT_EQ(written.sources[i].time_offset_s, found["cameras"][i]["time_offset_s"].get<double>());
  const ProgramRun again = Offsets(folder / "late.yml");
  ASSERT_EQ(again.exit_status, 0) << again.err;
  ExpectOffsets(nlohmann::json::parse(again.out), {0.0, 0.0, 0.0, 0.0}, kMostS);
}

TEST(OffsetsCommand, WithoutStampsItWarnsThatTheyServeNothing) {
  const TemporaryFolder folder;
  recon::RigFile rig_file = recon::ReadRigFile(
      test_support::WriteHandFootage(folder.path(), {.offset_s = {0.0, 0.0, 0.0}, .seconds = 9.0}));
  for (recon::CameraSources& sources : rig_file.sources) sources.timestamps.clear();
  recon::WriteRigFile(rig_file, folder / "plain.yml");
  const ProgramRun run = Offsets(folder / "plain.yml");
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json found = nlohmann::json::parse(run.out);
  ASSERT_EQ(found["warnings"].size(), 1U);
  EXPECT_THAT(found["warnings"][0].get<std::string>(), HasSubstr("no stamps"));
  // Frames of one number are 7 ms apart from camera to camera, and nominally at 25 Hz instead of 20.
  constexpr double kPhaseS = 0.007 * 20.0 / 25.0;
  ExpectOffsets(found, {0.0, kPhaseS, 2.0 * kPhaseS}, 0.003);
}

TEST(OffsetsCommand, StillHandsTellNothing) {
  const TemporaryFolder folder;
  const std::filesystem::path rig = test_support::WriteHandFootage(
      folder.path(), {.offset_s = {0.0, 0.01, 0.0}, .motion = {.speed = 0.001}});
  const ProgramRun run = Offsets(rig, {"--out", (folder / "late.yml").string()});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("don't tell the time offsets"), HasSubstr("move hands")));
  EXPECT_FALSE(std::filesystem::exists(folder / "late.yml"));
}

// Small pictures of the light, as each camera took them.
std::filesystem::path WriteBlinkFootage(const std::filesystem::path& folder,
                                        const std::vector<double>& offset_s, double peak_levels) {
  constexpr double kSeconds = 25.0, kExposureS = 0.012;
  const recon::testing::BlinkingLight light(7, kSeconds + 2.0);
  recon::RigFile file = recon::testing::PlainRig(std::vector<recon::CameraSources>(offset_s.size()));
  for (std::size_t i = 0; i < offset_s.size(); ++i) {
    const std::string name = file.rig.cameras[i].name();
    std::filesystem::create_directories(folder / name);
    const recon::testing::BlinkCamera camera{.seed = i + 1,
                                             .offset_s = offset_s[i],
                                             .exposure_s = kExposureS,
                                             .phase_s = 0.5 + 0.009 * static_cast<double>(i),
                                             .dropped_share = 0.0};
    const recon::testing::BlinkPictures pictures = recon::testing::TakeBlinkPictures(camera, kSeconds);
    std::string stamps = "frame,time_s\n";
    for (std::size_t k = 0; k < pictures.stamp_s.size(); ++k) {
      cv::imwrite((folder / name / fmt::format("f_{:04}.png", k)).string(),
                  recon::testing::BlinkPicture(light, {.peak_levels = peak_levels}, pictures.true_s[k],
                                               kExposureS, 1000 * i + k));
      stamps += fmt::format("{},{:.6f}\n", k, pictures.stamp_s[k]);
    }
    test_support::WriteText(folder / name / "stamps.csv", stamps);
    recon::CameraSources& sources = file.sources[i];
    sources.frames = (folder / name / "f_%04d.png").string();
    sources.timestamps = (folder / name / "stamps.csv").string();
    sources.capture.exposure_us = 1e6 * kExposureS;
  }
  recon::WriteRigFile(file, folder / "rig.yml");
  return folder / "rig.yml";
}

TEST(OffsetsCommand, FromALightThatBlinks) {
  const std::vector<double> true_s = {0.0, 0.013, -0.006};
  constexpr double kMostS = 0.0005;
  const TemporaryFolder folder;
  const ProgramRun run = Offsets(WriteBlinkFootage(folder.path(), true_s, 600.0), {"--by", "light"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json found = nlohmann::json::parse(run.out);
  ExpectOffsets(found, true_s, kMostS);
  EXPECT_GT(found["edges"].get<int>(), 50);
}

TEST(OffsetsCommand, ADarkLightIsNamedByCamera) {
  const TemporaryFolder folder;
  const ProgramRun run = Offsets(WriteBlinkFootage(folder.path(), {0.0, 0.0}, 10.0), {"--by", "light"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("camera 'cam1' sees no blinking light"), HasSubstr("let a lamp go")));
}

}  // namespace
}  // namespace elbowroom
