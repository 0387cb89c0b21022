#include "tests/accuracy/measurements.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "tests/accuracy/callgrind.h"
#include "tests/accuracy/peak_memory.h"
#include "tests/accuracy/scale/hull_bounds.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::accuracy {
namespace {

using test_support::ReadText;
using test_support::WriteText;

TEST(WriteMicroTable, TellsWhatGoogleBenchmarkMeasured) {
  const test_support::TemporaryFolder folder;
  WriteText(folder / "performance.md",
            "before\n<!-- bench:micro begin -->\n<!-- bench:micro end -->\nafter\n");
  WriteText(folder / "run.json",
            R"({"benchmarks": [
              {"run_name": "Project", "run_type": "iteration", "repetitions": 3, "real_time": 9.0, "time_unit": "us"},
              {"run_name": "Project", "run_type": "aggregate", "aggregate_name": "median", "repetitions": 3,
               "real_time": 12.5, "time_unit": "us", "items_per_second": 8e7, "differing": NaN},
              {"run_name": "View", "run_type": "iteration", "real_time": 3.21, "time_unit": "ms"}]})");
  WriteMicroTable(folder.path(), folder / "run.json");
  const std::string text = ReadText(folder / "performance.md");
  EXPECT_NE(text.find("| Project | 12.5 us | 12.5 ns |\n| View | 3.21 ms | - |\n"), std::string::npos)
      << text;
  EXPECT_TRUE(text.starts_with("before\n"));
  EXPECT_TRUE(text.ends_with("\nafter\n"));
  EXPECT_THROW(WriteMicroTable(folder.path(), folder / "performance.md"), core::Error);
}

// A document whose tables hold all that the aims ask for.
std::string MeasuredDocument(const std::string& exact_three) {
  std::string methods = "| method | scene | 1 thread, ms | 2 threads, ms |\n| --- | ---: | ---: | ---: |\n";
  for (const std::string scene : {"3 cameras, 640 x 480", "8 cameras, 1280 x 720"}) {
    methods += "| exact view, CPU | " + scene + " | " + exact_three + " | 1.00 |\n";
    methods += "| plane sweep, CPU, planes 15 mm apart | " + scene + " | 4.00 | 2.50 |\n";
    methods += "| plain plane sweep, CPU, planes 15 mm apart | " + scene + " | 8.00 | 5.00 |\n";
    methods += "| plane sweep, GL, planes 15 mm apart | " + scene + " | 60.0 | 50.0 |\n";
  }
  std::string micro = "| benchmark | time | time an item |\n| --- | ---: | ---: |\n";
  for (const std::string name :
       {"ExactView/three_cameras", "ExactView/eight_cameras", "MeshAt2Mm/three_cameras",
        "MeshAt2Mm/four_cameras", "MeshAt2Mm/eight_cameras"})
    micro += "| " + name + "/1 | 1.50 ms | - |\n| " + name + "/2 | 900 us | - |\n";
  micro += "| OpenCvMog2 | 20.0 ms | - |\n| SegmentDetect | 500 us | - |\n| SegmentWhole | 2.00 ms | - |\n";
  return "<!-- bench:methods begin -->\n" + methods +
         "<!-- bench:methods end -->\n<!-- bench:micro begin -->\n" + micro +
         "<!-- bench:micro end -->\n<!-- bench:aims begin -->\n<!-- bench:aims end -->\n";
}

TEST(WriteAimsTable, HoldsTheOtherTablesToTheAims) {
  const test_support::TemporaryFolder folder;
  WriteText(folder / "performance.md", MeasuredDocument("2.00"));
  WriteAimsTable(folder.path());
  const std::string text = ReadText(folder / "performance.md");
  for (const char* row :
       {"| exact view in turns with all methods: 3 cameras, 640 x 480 | <= 2.00 ms | 2.00 | <= 1.20 ms | "
        "1.00 | yes |",
        "| exact view repeated alone: 3 cameras, 640 x 480 | <= 2.00 ms | 1.50 | <= 1.20 ms | 0.900 | yes |",
        "| exact view against plane sweep, GL, planes 15 mm apart: 3 cameras, 640 x 480 | >= 25 x | 30.0 x | "
        ">= 25 x "
        "| 50.0 x | yes |",
        "| exact view against plane sweep, CPU, planes 15 mm apart: 3 cameras, 640 x 480 | >= 3 x | 2.0 x | "
        ">= 3 x | "
        "2.5 x | no |",
        "| exact view against plain plane sweep, CPU, planes 15 mm apart: 3 cameras, 640 x 480 | >= 3 x | "
        "4.0 x "
        "| >= 3 x | 5.0 x | yes |",
        "| hull mesh, edges of 2 mm: 3 cameras, 640 x 480 | - | 1.50 | <= 10.0 ms | 0.900 | yes |",
        "| segmentation of 4 pictures: whole, with levels | <= 0.600 ms | 2.00 | - | - | no |",
        "| segmentation against MOG2: detection | >= 15 x | 40.0 x | - | - | yes |"})
    EXPECT_NE(text.find(row), std::string::npos) << row << "\nin\n" << text;
  WriteAimsTable(folder.path());
  EXPECT_EQ(ReadText(folder / "performance.md"), text);
}

TEST(WriteAimsTable, NamesTheFigureThatIsMissing) {
  const test_support::TemporaryFolder folder;
  for (const auto& [without, named] : {std::pair<std::string, std::string>{"OpenCvMog2", "OpenCvMog2"},
                                       {"exact view, CPU", "exact view, CPU"},
                                       {"2.00", "number"}}) {
    std::string document = MeasuredDocument("2.00");
    document.replace(document.find(without), without.size(), "nothing");
    WriteText(folder / "performance.md", document);
    try {
      WriteAimsTable(folder.path());
      FAIL() << without;
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
  }
}

TEST(CountInstructions, FollowsTheHullOnScreenAndKnowsAnUnchangedFrame) {
  const auto count = [](const std::vector<std::string>& arguments) {
    return CountInstructions(ELBOWROOM_VIEW_COST, arguments, "*CountedView*");
  };
  try {
    (void)count({"--zoom", "0.25"});
  } catch (const core::Error& error) {
    const std::string what = error.what();
    if (what.find("doesn't know an instruction") != std::string::npos) GTEST_SKIP() << "NOT TESTED: " << what;
    throw;
  }
  const CallgrindCount fresh = count({"--zoom", "0.25"}), larger = count({"--zoom", "0.5"}),
                       again = count({"--zoom", "0.25", "--unchanged"}),
                       beside = count({"--zoom", "0.25", "--unchanged", "--moved"});
  EXPECT_GT(std::stoi(larger.output), 3 * std::stoi(fresh.output));
  constexpr std::int64_t kAtLeast = 100'000;  // were it less, nothing was counted
  EXPECT_GT(fresh.instructions, kAtLeast);
  EXPECT_GT(larger.instructions, fresh.instructions);
  EXPECT_EQ(again.output, fresh.output);
  EXPECT_LT(again.instructions, fresh.instructions);
  EXPECT_LT(beside.instructions, fresh.instructions);
  EXPECT_GT(again.instructions, 0);
}

TEST(CountInstructions, SaysInOneLineWhatToInstall) {
  try {
    (void)CountInstructions("/bin/true", {}, "main", "valgrind-that-is-not-there");
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_STREQ(
        error.what(),
        "'valgrind-that-is-not-there' isn't installed, so nothing is counted; install the package valgrind");
  }
}

TEST(PeakMemoryOf, TellsAProgramFromItsChild) {
  constexpr std::int64_t kHeldBytes = 50'000'000;
  const PeakMemory peak =
      PeakMemoryOf("/bin/sh", {"-c", "head -c 50000000 /dev/zero | tail -c 50000000 > /dev/null; true"});
  EXPECT_GT(peak.child_bytes, kHeldBytes);
  EXPECT_GT(peak.program_bytes, 0);
  EXPECT_LT(peak.program_bytes, kHeldBytes);
  EXPECT_THROW((void)PeakMemoryOf("/bin/false", {}), core::Error);
}

TEST(MeasureScale, WritesItsTablesAndFindsTheSameResultsEverywhere) {
  const test_support::TemporaryFolder folder;
  std::string document;
  for (const char* section : {"growth", "engines", "change", "hulls", "hull_bounds", "store", "site"})
    document += "<!-- bench:" + std::string(section) + " begin -->\n<!-- bench:" + section + " end -->\n";
  WriteText(folder / "scale.md", document);
  MeasureScale(folder.path(), test_support::ProgramFile(), {2, 1}, 0.5);
  const std::string text = ReadText(folder / "scale.md");
  EXPECT_EQ(text.find("NO"), std::string::npos) << text;
  for (const char* row :
       {"\n| 1 | ", "\n| 2 | ", "\n| `local`, all cells kept | ", "\n| one more revision of payload A | ",
        "\n| boxes around it, edges up to 16 mm | ", "\n| a cover beside payload B | ",
        "\n| a session's file | ", "\n| one more revision of a part | "})
    EXPECT_NE(text.find(row), std::string::npos) << row << '\n' << text;
}

TEST(HullBound, HoldsEachPointOfTheHull) {
  recon::Random random(26);
  int inside = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const recon::RandomScene scene = recon::MakeRingScene(&random, random.Whole(1, 5), unseen);
    const recon::VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    const HullBound bound = BoundOf(hull, random.Uniform(20.0, 60.0));
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d x = random.PointIn(hull.rig().workspace_mm);
      if (!hull.Contains(x)) continue;
      ++inside;
      EXPECT_EQ(bound.DistanceMm({x, x}), 0.0);
    }
  }
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace elbowroom::accuracy
