// Every command, started in the folder of its files and given their names alone; and names that are formulas
// or no UTF-8.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramRun;

constexpr const char* kView = R"(%YAML:1.0
---
name: "head"
image_width: 64
image_height: 48
camera_matrix: [60, 0, 31.5, 0, 60, 23.5, 0, 0, 1]
distortion_model: "plumb_bob"
distortion_coefficients: [0, 0, 0, 0, 0]
rotation_cam_from_world: [1, 0, 0, 0, -1, 0, 0, 0, -1]
translation_cam_from_world_mm: [0, 0, 900]
)";
constexpr const char* kPose = R"(%YAML:1.0
---
rotation_world_from_part: [1, 0, 0, 0, 1, 0, 0, 0, 1]
translation_world_from_part_mm: [80, 0, 200]
)";

std::string LayoutOf(const std::string& lower, const std::string& gap) {
  return "unit = \"mm\"\n[[part]]\nname = '" + lower +
         "'\nfile = \"box.stl\"\nposition_mm = [80, 0, 100]\n"
         "[[part]]\nname = \"upper\"\nfile = \"box.stl\"\nposition_mm = [80, 0, 200]\n[[spacing]]\nname = '" +
         gap + "'\nmoving = \"upper\"\nreference = '" + lower +
         "'\naxis = \"z\"\nmin_mm = 0\nmax_mm = 200\ninitial_mm = 20\n";
}

class InItsFolder : public testing::Test {
 protected:
  void SetUp() override {
    test_support::WriteBallRig(folder_.path());
    test_support::WriteBoxStl(folder_ / "box.stl", 80.0);
    test_support::WriteText(folder_ / "view.yml", kView);
    test_support::WriteText(folder_ / "pose.yml", kPose);
    test_support::WriteText(folder_ / "layout.toml", LayoutOf("lower", "gap"));
    test_support::WriteText(folder_ / "trial.toml", "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n");
  }
  [[nodiscard]] ProgramRun Run(const std::vector<std::string>& words) const {
    return test_support::RunProgram(
        test_support::ProgramFile(), words,
        {.working_folder = folder_.path(), .environment = {{"ELBOWROOM_CACHE", "cache"}}});
  }
  void ExpectSuccess(const std::vector<std::string>& words, const std::vector<fs::path>& made) const {
    const ProgramRun run = Run(words);
    EXPECT_EQ(run.exit_status, 0) << words.front() << ": " << run.err;
    for (const fs::path& file : made) EXPECT_TRUE(fs::exists(folder_ / file)) << words.front() << ' ' << file;
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(InItsFolder, ATrialWithAViewer) {
  fs::create_directory(folder_ / "pictures");
  for (const char* camera : {"cam1"})
    fs::copy_file(folder_.path() / camera / "mask_0000.png", folder_ / "pictures" / "head_0.png");
  std::string view = kView;
  view.replace(view.find("64"), 2, "320");
  view.replace(view.find("48"), 2, "240");
  test_support::WriteText(folder_ / "head.yml", view);
  test_support::WriteText(folder_ / "viewed.toml",
                          "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n[viewer]\ncamera = \"head.yml\"\n"
                          "frames = \"pictures/head_%d.png\"\n");
  ExpectSuccess({"trial", "run", "viewed.toml", "--session", "s.db", "--headless"}, {"s.db"});
}

TEST_F(InItsFolder, ATrialItsReportAndItsSweep) {
  ExpectSuccess({"trial", "run", "trial.toml", "--session", "s.db", "--headless"}, {"s.db"});
  ExpectSuccess({"report", "s.db", "--out", "report"}, {"report/report.html", "report/contacts.csv"});
  ExpectSuccess({"report", "s.db", "--out", "."}, {"report.html", "clearance.csv"});
  ExpectSuccess({"sweep", "s.db", "--spacing", "gap=0:40:20", "--out", "sweep"}, {"sweep/sweep.csv"});
}

TEST_F(InItsFolder, ARigsFrame) {
  const std::vector<std::string> part = {"--mesh", "box.stl",           "--unit",
                                         "mm",     "--world-from-part", "pose.yml"};
  ExpectSuccess({"segment", "rig.yml", "--frame", "0", "--out", "masks"}, {"masks/cam1_0000.png"});
  ExpectSuccess({"segment", "rig.yml", "--frame", "0", "--out", "."}, {"cam1_0000.png"});
  ExpectSuccess(
      {"view", "rig.yml", "--frame", "0", "--camera", "view.yml", "--depth", "d.tiff", "--image", "i.png"},
      {"d.tiff", "i.png"});
  ExpectSuccess({"hull", "rig.yml", "--frame", "0", "--edge", "10", "--out", "hull.ply"}, {"hull.ply"});
  for (const char* command : {"contacts", "clearance"}) {
    std::vector<std::string> words = {command, "rig.yml", "--frame", "0"};
    words.insert(words.end(), part.begin(), part.end());
    ExpectSuccess(words, {});
  }
}

TEST_F(InItsFolder, ALayoutAndItsParts) {
  ExpectSuccess({"import", "box.stl", "--unit", "mm"}, {"cache"});
  ExpectSuccess({"layout", "show", "layout.toml"}, {});
  ExpectSuccess({"layout", "new", "new.toml", "box.stl", "--unit", "mm"}, {"new.toml"});
  ExpectSuccess({"clash", "layout.toml"}, {});
}

TEST_F(InItsFolder, NoTableHoldsAFormula) {
  const std::string part = "=cmd|calc!A0", gap = "@gap";
  test_support::WriteText(folder_ / "layout.toml", LayoutOf(part, gap));
  ExpectSuccess({"trial", "run", "trial.toml", "--session", "s.db", "--headless"}, {"s.db"});
  ExpectSuccess({"report", "s.db", "--out", "out"}, {});
  ExpectSuccess({"sweep", "s.db", "--spacing", gap + "=0:40:20", "--out", "out"}, {});
  int tables = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "out")) {
    if (entry.path().extension() != ".csv") continue;
    ++tables;
    const std::string csv = test_support::ReadText(entry.path());
    for (const char* raw : {",=", ",\"=", "\n=", ",@", ",\"@"})
      EXPECT_EQ(csv.find(raw), std::string::npos) << entry.path() << csv;
  }
  EXPECT_EQ(tables, 3);
  EXPECT_NE(test_support::ReadText(folder_.path() / "out" / "sweep.csv").find(",\"'" + part + "\","),
            std::string::npos);
}

TEST_F(InItsFolder, APathThatIsNoUtf8IsRecordedAndPrinted) {
  const std::string session = "M\xFCller.db";
  const ProgramRun run = Run({"trial", "run", "trial.toml", "--session", session, "--headless", "--json"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["session"], "M\uFFFDller.db");
  EXPECT_TRUE(fs::exists(folder_ / session));
  const ProgramRun again = Run({"trial", "run", "trial.toml", "--session", session, "--headless", "--json"});
  EXPECT_EQ(again.exit_status, 1);
  EXPECT_NE(again.err.find(R"(M\xfcller.db)"), std::string::npos) << again.err;
}

}  // namespace
}  // namespace elbowroom
