// The spacing swept as a user does it, over a few recorded frames of the demo.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/control/demo_parts.h"
#include "app/control/frame_pipeline.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "sessions/session_writer.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;

std::string Contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// Six frames of the task at 140 mm, from exact masks; how many of them payload A is touched in.
int RecordFrames(const std::filesystem::path& path) {
  const recon::SyntheticRig source(recon::FourCameraRig(),
                                   [](double time_s) { return recon::DemoSceneAt(time_s).objects; });
  core::SessionHeader header;
  header.rig = source.rig();
  header.layout = control::DemoLayout();
  header.trial.estimate_mm = 184.0;
  header.trial.required_clearance_mm = 15.0;
  control::FramePipeline pipeline(source.rig(), control::DemoLayout(),
                                  std::vector<recon::BackgroundReference>(4), {});
  sessions::SessionWriter writer(path, header);
  int touched = 0;
  for (core::FrameIndex frame = 20; frame < 80; frame += 10) {
    recon::FrameSet frames;
    frames.index = frame;
    for (core::BitMask& mask : source.TrueMasks(source.ObjectsAt(frame)))
      frames.cameras.push_back({{}, std::move(mask)});
    const auto result = pipeline.Process(std::move(frames), std::vector{140.0});
    touched += result->record.contacts[1].verdict == core::Verdict::kContact ? 1 : 0;
    writer.Append(result->record);
  }
  writer.Finish({});
  return touched;
}

class SweepCommand : public testing::Test {
 protected:
  [[nodiscard]] ProgramRun Sweep(const std::string& spacing,
                                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"sweep", (folder_ / "s.db").string(), "--spacing", spacing,
                                       "--out", (folder_ / "out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(ELBOWROOM_PROGRAM, arguments);
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(SweepCommand, FindsTheSpaceThatTheTaskNeeds) {
  const int touched = RecordFrames(folder_ / "s.db");
  ASSERT_GT(touched, 0);
  const ProgramRun run = Sweep("payload_a_gap=140:240:50", {"--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["moved"], nlohmann::json::array({"payload_a"}));
  ASSERT_EQ(json["steps"].size(), 3U);
  EXPECT_EQ(json["steps"][0]["parts"][1]["frames_in_contact"], touched) << "as recorded";
  EXPECT_EQ(json["steps"][2]["parts"][1]["frames_in_contact"], 0);
  EXPECT_GT(json["steps"][2]["parts"][1]["lower_mm"].get<double>(), 0.0);
  const double touched_mm = json["largest_touched_mm"], free_mm = json["smallest_free_mm"];
  EXPECT_LT(touched_mm, free_mm);
  EXPECT_LE(free_mm, 240.0);
  EXPECT_GE(touched_mm, 140.0);
  EXPECT_EQ(json["unmoved"], 6 * 2 * 2) << "frames, parts, steps but one";
  const std::string csv = Contents(folder_ / "out/sweep.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 3);
  EXPECT_NE(csv.find("\n140,payload_a,1," + std::to_string(touched) + ","), std::string::npos) << csv;
  EXPECT_TRUE(Contents(folder_ / "out/sweep.svg").starts_with("<svg"));
  EXPECT_TRUE(Contents(folder_ / "out/sweep.png").starts_with("\x89PNG"));
}

TEST_F(SweepCommand, SaysWhatIsWrongInOneLineAndLeavesNothing) {
  RecordFrames(folder_ / "s.db");
  for (const auto& [spacing, word] : {std::pair{"payload_gap=140:240:50", "did you mean 'payload_a_gap'"},
                                      std::pair{"payload_a_gap=10:240:50", "from 60 to 400"}}) {
    const ProgramRun run = Sweep(spacing);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  }
  for (const char* usage : {"payload_a_gap=140", "payload_a_gap=240:140:10", "=1:2:3", "payload_a_gap=1:2:0"})
    EXPECT_EQ(Sweep(usage).exit_status, 2) << usage;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace elbowroom
