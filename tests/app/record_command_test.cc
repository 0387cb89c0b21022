// elbowroom cameras record, as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "recon/footage/recorded_rig.h"
#include "tests/app/live_demo.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

using test_support::ProgramRun;
using test_support::RunProgram;
using ::testing::HasSubstr;

TEST(RecordCommand, RecordsAndSaysWhat) {
  const DemoFootage demo = RenderDemo();
  const test_support::TemporaryFolder folder;
  recon::testing::ServedRig served(demo.sets, kRateHz);
  recon::WriteRigFile(LiveRigFile(demo, served, folder.path()), folder / "RIG.yml");
  const std::vector<std::string> arguments{
      "cameras", "record", (folder / "RIG.yml").string(), "--out", (folder / "out").string(), "--seconds",
      "1.5",     "--json"};
  const ProgramRun run = RunProgram(test_support::ProgramFile(), arguments);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_GE(json["seconds"].get<double>(), 1.5);
  EXPECT_EQ(json["ended_early"], false);
  ASSERT_EQ(json["cameras"].size(), std::size_t{kCameras});
  std::uint64_t video_bytes = 0;
  for (const auto& camera : json["cameras"]) {
    EXPECT_GT(camera["frames"].get<int>(), 0);
    EXPECT_GE(camera["lost"].get<int>(), 0);
    EXPECT_GE(camera["unwritten"].get<int>(), 0);
    video_bytes += std::filesystem::file_size(camera["file"].get<std::string>());
  }
  EXPECT_GT(json["bytes"].get<std::uint64_t>(), video_bytes);  // and the tables
  recon::RecordedRig rig(recon::ReadRigFile(json["rig"].get<std::string>()));
  EXPECT_GT(rig.frame_count().value(), 0);

  const ProgramRun again = RunProgram(test_support::ProgramFile(), arguments);
  EXPECT_EQ(again.exit_status, 1);
  EXPECT_EQ(again.out, "");
  EXPECT_THAT(again.err, HasSubstr("there is something in it already; choose a new folder"));
}

}  // namespace
}  // namespace elbowroom::control
