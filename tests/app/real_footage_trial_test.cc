// A trial on footage that nobody here made: a person on a chair, seen by four cameras.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "recon/rig_files/rig_file.h"
#include "sessions/session_reader.h"
#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

constexpr int kFramesInAll = 426;
constexpr int kFramesHere = 24;  // times the soak scale; 20 covers them all

// Boxes of 300 mm: one reaches into the person's lap, one stands 300 mm beside, one across the room.
constexpr const char* kLayout = R"(unit = "mm"
[[part]]
name = "reaches_in"
file = "box.stl"
position_mm = [370, -100, 700]
[[part]]
name = "beside"
file = "box.stl"
position_mm = [370, 750, 700]
[[part]]
name = "across"
file = "box.stl"
position_mm = [2600, -1800, 700]
)";

TEST(RealFootageTrial, OneLongTouchWhereThePersonIsAndNoneElsewhere) {
  const std::filesystem::path rig = test_support::SharedDataFolder() / "four_cameras" / "rig.yml";
  if (!std::filesystem::exists(rig)) GTEST_SKIP() << "NOT TESTED: no footage at " << rig;
  const test_support::TemporaryFolder folder;
  test_support::WriteBoxStl(folder / "box.stl", 300.0);
  test_support::WriteText(folder / "layout.toml", kLayout);
  test_support::WriteText(folder / "trial.toml", "rig = \"" + std::filesystem::canonical(rig).string() +
                                                     "\"\nlayout = \"layout.toml\"\n");
  const int frames = std::min(kFramesInAll, kFramesHere * test_support::SoakScale());
  const test_support::ProgramRun run = test_support::RunProgram(
      test_support::ProgramFile(),
      {"trial", "run", (folder / "trial.toml").string(), "--session", (folder / "s.db").string(),
       "--headless", "--json", "--frames", "0:" + std::to_string(frames)});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["frames"], frames);
  EXPECT_GE(json["parts"][0]["frames_in_contact"].get<int>(), frames * 98 / 100);  // "nearly every frame"
  EXPECT_EQ(json["parts"][0]["episodes"], 1);
  EXPECT_EQ(json["parts"][1]["frames_in_contact"], 0);
  EXPECT_EQ(json["parts"][2]["frames_in_contact"], 0);
  const sessions::SessionReader session(folder / "s.db");
  ASSERT_EQ(session.episodes().size(), 1U);
  EXPECT_EQ(session.episodes()[0].begin_frame, 0);
  EXPECT_EQ(session.episodes()[0].end_frame, frames - 1);
  // The deepest point lies within the box and within the person's bounds (the data's README), to a pixel.
  const Eigen::AlignedBox3d person(Eigen::Vector3d(79, -511, 0), Eigen::Vector3d(658, 300, 1410));
  EXPECT_LT(person.exteriorDistance(session.episodes()[0].peak_position_in_world_mm), 10.0);
}

}  // namespace
}  // namespace elbowroom
