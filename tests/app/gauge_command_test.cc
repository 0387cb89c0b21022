// A rod moved through the paper's rig, gauged as a user does it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recon/images/mask_image.h"
#include "recon/rig_files/rig_file.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/recon/gauge/rod_scene.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using recon::testing::Rod;
using test_support::ProgramRun;
using ::testing::HasSubstr;

constexpr int kPlaces = 27;
constexpr int kEmptyFrame = kPlaces;  // the frame after the last place shows nothing

// Ready masks of the rod at 27 places and of an empty scene, and a rig file. A turned camera: the file is
// wrong.
std::filesystem::path WriteRodRig(const std::filesystem::path& folder, double turned_deg = 0.0) {
  const core::Rig rig = recon::PaperRig();
  recon::testing::RodStage stage(rig, recon::testing::Silhouettes::kReady);
  std::vector<std::vector<recon::SyntheticObject>> frames;
  for (const Rod& rod : recon::testing::TwentySevenRods(rig, 0.5, 10.0, 300.0))
    frames.push_back({recon::testing::RodObject(rod)});
  frames.emplace_back();
  recon::RigFile file{turned_deg == 0.0
                          ? rig
                          : recon::testing::WithTurnedCamera(rig, 1, turned_deg,
                                                             rig.cameras[1].cam_from_world().rotation.row(1)),
                      {}};
  for (const core::CameraModel& camera : rig.cameras) {
    std::filesystem::create_directories(folder / camera.name());
    file.sources.push_back({"", "", (folder / camera.name() / "mask_%04d.png").string()});
  }
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const auto masks = stage.MasksOf(frames[frame]);
    for (std::size_t i = 0; i < masks.size(); ++i)
      recon::WriteMaskPng(masks[i].mask,
                          folder / rig.cameras[i].name() / fmt::format("mask_{:04}.png", frame));
  }
  recon::WriteRigFile(file, folder / "rig.yml");
  return folder / "rig.yml";
}

const std::filesystem::path& TrueRig() {
  static const test_support::TemporaryFolder folder;
  static const std::filesystem::path rig = WriteRodRig(folder.path());
  return rig;
}

ProgramRun Gauge(const std::filesystem::path& rig, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"gauge", rig.string()});
  return test_support::RunProgram(test_support::ProgramFile(), arguments);
}

nlohmann::json JsonOf(const ProgramRun& run) {
  EXPECT_EQ(run.exit_status, 0) << run.err;
  return nlohmann::json::parse(run.out);
}

// Stamps of which one camera's second is missing: without that picture, a rod would look larger than it is.
TEST(GaugeCommand, AFrameThatLacksACameraIsNotMeasured) {
  const test_support::TemporaryFolder folder;
  recon::RigFile rig_file = recon::ReadRigFile(WriteRodRig(folder.path()));
  for (std::size_t i = 0; i < rig_file.sources.size(); ++i) {
    std::string stamps = "frame,time_s\n";
    for (int frame = 0; frame < 12; ++frame)
      if (i != 1 || frame != 5) stamps += fmt::format("{},{}\n", frame, 0.1 * frame);
    rig_file.sources[i].timestamps = (folder / fmt::format("{}.csv", i)).string();
    test_support::WriteText(rig_file.sources[i].timestamps, stamps);
  }
  recon::WriteRigFile(rig_file, folder / "stamped.yml");
  const auto json = JsonOf(Gauge(folder / "stamped.yml", {"--frames", "3:7", "--rod", "10", "--json"}));
  EXPECT_EQ(json["places"], 3);
  const std::string& lacking = rig_file.rig.cameras[1].name();
  EXPECT_THAT(json["warnings"].dump(),
              HasSubstr(fmt::format("frame 5: no rod: the picture of camera '{}' is missing", lacking)));
}

TEST(GaugeCommand, IsWithinItsBoundAt27Places) {
  const auto json =
      JsonOf(Gauge(TrueRig(), {"--frames", "0:27", "--rod", "10", "--length", "300", "--json"}));
  EXPECT_EQ(json["places"], kPlaces);
  EXPECT_EQ(json["frames"].size(), kPlaces);
  EXPECT_EQ(json["true_diameter_mm"], 10.0);
  EXPECT_EQ(json["true_length_mm"], 300.0);
  EXPECT_TRUE(json["passed"]) << json.dump(1);
  EXPECT_FALSE(json["saved"]);
  EXPECT_NEAR(json["diameter_mm"].get<double>() - 10.0, json["error_mm"].get<double>(), 1e-12);
  double largest_mm = 0.0;
  for (const auto& place : json["frames"]) {
    const double error_mm = place["error_mm"], bound_mm = place["bound_mm"];
    EXPECT_LE(std::abs(error_mm), bound_mm);
    EXPECT_LE(std::abs(place["length_error_mm"].get<double>()), place["length_bound_mm"].get<double>());
    EXPECT_LE(place["straightness_mm"].get<double>(), place["straightness_bound_mm"].get<double>());
    EXPECT_NEAR(place["bound"]["silhouettes_mm"].get<double>() + place["bound"]["distance_mm"].get<double>() +
                    place["bound"]["calibration_mm"].get<double>(),
                bound_mm, 1e-9);
    EXPECT_TRUE(place["passed"]);
    EXPECT_EQ(place["position_mm"].size(), 3U);
    EXPECT_EQ(place["direction"].size(), 3U);
    EXPECT_EQ(place["cameras"].size(), 3U);
    largest_mm = std::max(largest_mm, std::abs(error_mm));
  }
  EXPECT_EQ(std::abs(json["error_mm"].get<double>()), largest_mm);
  EXPECT_GT(json["time_ms"].get<double>(), 0.0);
  // The rig has no covariance, which is said.
  ASSERT_EQ(json["warnings"].size(), 1U);
  EXPECT_THAT(json["warnings"][0].get<std::string>(), HasSubstr("no covariance"));
}

TEST(GaugeCommand, KeepsItsResultAndWritesAPage) {
  const test_support::TemporaryFolder folder;
  const auto rig = WriteRodRig(folder.path());
  const std::string before = test_support::ReadText(rig);
  const auto json = JsonOf(Gauge(rig, {"--frame", "3", "--frame", "12", "--frames", "20:27:3", "--rod", "10",
                                       "--out", (folder / "page").string(), "--save", "--json"}));
  EXPECT_EQ(json["places"], 5);
  EXPECT_TRUE(json["saved"]);
  const auto gauge = recon::ReadRigFile(rig).gauge;
  ASSERT_TRUE(gauge);
  EXPECT_EQ(gauge->places, 5);
  EXPECT_TRUE(gauge->passed);
  EXPECT_EQ(gauge->true_diameter_mm, 10.0);
  EXPECT_EQ(gauge->error_mm, json["error_mm"].get<double>());
  EXPECT_EQ(gauge->bound_mm, json["bound_mm"].get<double>());
  EXPECT_EQ(gauge->diameter_mm, json["diameter_mm"].get<double>());
  EXPECT_THAT(test_support::ReadText(rig), ::testing::StartsWith(before));
  const std::string page = test_support::ReadText(folder / "page" / "gauge.html");
  EXPECT_THAT(page, HasSubstr("The rig passes"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, ::testing::Not(HasSubstr("http:")));
  EXPECT_THAT(page, ::testing::Not(HasSubstr("https:")));
}

TEST(GaugeCommand, FailsARodOfAnotherDiameterAndLength) {
  const auto json =
      JsonOf(Gauge(TrueRig(), {"--frames", "0:27", "--rod", "12", "--length", "340", "--json"}));
  EXPECT_FALSE(json["passed"]);
  EXPECT_NEAR(json["error_mm"].get<double>(), -2.0, 0.1);
  for (const auto& place : json["frames"]) EXPECT_FALSE(place["passed"]) << place["frame"];
  EXPECT_THAT(json["frames"][4]["faults"].dump(), HasSubstr("the length is"));
}

TEST(GaugeCommand, FailsARigWithATurnedCamera) {
  for (const double angle_deg : {0.5, 1.0}) {
    const test_support::TemporaryFolder folder;
    const auto rig = WriteRodRig(folder.path(), angle_deg);
    const ProgramRun run = Gauge(rig, {"--frames", "0:27", "--rod", "10", "--save", "--json"});
    const auto json = JsonOf(run);
    EXPECT_FALSE(json["passed"]);
    EXPECT_THAT(run.err, HasSubstr("the gauge failed"));
    EXPECT_FALSE(recon::ReadRigFile(rig).gauge->passed);
    int failed = 0;
    for (const auto& place : json["frames"]) failed += place["passed"].get<bool>() ? 0 : 1;
    EXPECT_GE(failed, 20) << angle_deg;
    EXPECT_THAT(json["frames"].dump(), HasSubstr("beside where the others see it"));
  }
}

TEST(GaugeCommand, SaysWhatItSawWhereThereIsNoRod) {
  const ProgramRun empty = Gauge(TrueRig(), {"--frame", fmt::format("{}", kEmptyFrame), "--rod", "10"});
  EXPECT_EQ(empty.exit_status, 1);
  EXPECT_EQ(std::ranges::count(empty.err, '\n'), 1);
  EXPECT_THAT(empty.err, HasSubstr("no camera sees anything"));
  const ProgramRun thick = Gauge(TrueRig(), {"--frame", "0", "--rod", "100"});
  EXPECT_EQ(thick.exit_status, 1);
  EXPECT_THAT(thick.err, HasSubstr("two straight edges"));
  // Among others it is a warning.
  const auto json = JsonOf(Gauge(TrueRig(), {"--frames", "25:28", "--rod", "10", "--json"}));
  EXPECT_EQ(json["places"], 2);
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("frame 27: no rod"));
}

TEST(GaugeCommand, RefusesWrongUsage) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--rod", "10"},
                                             {"--frame", "0"},
                                             {"--frame", "-1", "--rod", "10"},
                                             {"--frame", "0", "--rod", "0"},
                                             {"--frames", "5", "--rod", "10"},
                                             {"--frames", "5:1", "--rod", "10"},
                                             {"--frames", "1:5:0", "--rod", "10"},
                                             {"--frames", "1:99999999", "--rod", "10"},
                                             {"--frame", "0", "--rod", "10", "--length", "x"}}) {
    const ProgramRun run = Gauge(TrueRig(), arguments);
    EXPECT_EQ(run.exit_status, 2) << ::testing::PrintToString(arguments) << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1);
  }
  const ProgramRun beyond = Gauge(TrueRig(), {"--frame", "99", "--rod", "10"});
  EXPECT_EQ(beyond.exit_status, 1);
  EXPECT_THAT(beyond.err, HasSubstr("99"));
}

}  // namespace
}  // namespace elbowroom
