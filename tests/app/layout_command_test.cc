// elbowroom layout: from CAD files to a layout, without an editor.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "core/layout.h"
#include "sessions/session_reader.h"
#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;
using test_support::ReadText;

constexpr double kSinglePrecisionMm = 1e-3;  // of STL files of some metres

class LayoutCommand : public ::testing::Test {
 protected:
  LayoutCommand() : layout_((folder_ / "bench/layout.toml").string()) {
    // 8 in and 0.3 m: boxes of 203.2 and 300 mm.
    std::filesystem::create_directories(folder_ / "cad");
    std::filesystem::create_directories(folder_ / "bench");
    test_support::WriteBoxStl(folder_ / "cad/inch.stl", 8.0);
    test_support::WriteBoxStl(folder_ / "cad/metre.stl", 0.3);
  }
  [[nodiscard]] std::string Cad(const std::string& name) const { return (folder_ / "cad" / name).string(); }

  [[nodiscard]] ProgramRun Run(std::vector<std::string> words) const {
    words.insert(words.begin(), "layout");
    return test_support::RunProgram(test_support::ProgramFile(), words);
  }
  nlohmann::json Json(std::vector<std::string> words) const {
    words.emplace_back("--json");
    const ProgramRun run = Run(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }
  // One line on stderr that says all of `words`; the layout stays what it was.
  void ExpectFailure(const std::vector<std::string>& words, const std::vector<std::string>& said) const {
    const std::string before = std::filesystem::exists(layout_) ? ReadText(layout_) : "";
    const ProgramRun run = Run(words);
    EXPECT_EQ(run.exit_status, 1) << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    for (const std::string& word : said) EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
    EXPECT_EQ(std::filesystem::exists(layout_) ? ReadText(layout_) : "", before);
  }
  void MakeBench() const {
    Json({"new", layout_});
    Json({"add", layout_, Cad("inch.stl"), "--unit", "in", "--name", "box"});
    Json({"add", layout_, Cad("metre.stl"), "--unit", "m", "--position", "10", "-20.5", "900"});
    Json({"space", layout_, "gap", "--moving", "metre", "--reference", "box", "--axis", "z", "--min", "-50",
          "--max", "400", "--initial", "140"});
  }

  test_support::TemporaryFolder folder_;
  std::string layout_;
};

TEST_F(LayoutCommand, InchesAndMetresMeetAtTheRightSize) {
  MakeBench();
  const nlohmann::json json = Json({"show", layout_});
  ASSERT_EQ(json["parts"].size(), 2U);
  EXPECT_EQ(json["parts"][0]["unit"], "in");
  EXPECT_EQ(json["parts"][0]["file"], "../cad/inch.stl");
  EXPECT_EQ(json["parts"][1]["unit"], "m");
  EXPECT_EQ(json["parts"][1]["name"], "metre");
  for (const int axis : {0, 1, 2}) {
    EXPECT_NEAR(json["parts"][0]["size_mm"][axis].get<double>(), 203.2, kSinglePrecisionMm);
    EXPECT_NEAR(json["parts"][1]["size_mm"][axis].get<double>(), 300.0, kSinglePrecisionMm);
  }
  EXPECT_NEAR(json["spacings"][0]["gap_mm"].get<double>(), 140.0, kSinglePrecisionMm);
  const auto &box = json["parts"][0]["bounds_mm"], &metre = json["parts"][1]["bounds_mm"];
  EXPECT_NEAR(metre[0][2].get<double>() - box[1][2].get<double>(), 140.0, kSinglePrecisionMm);
  EXPECT_NEAR(json["parts"][1]["position_mm"][1].get<double>(), -20.5, kSinglePrecisionMm);
}

TEST_F(LayoutCommand, WithoutAUnitTheErrorNamesTheSizes) {
  ExpectFailure({"new", layout_, Cad("inch.stl"), Cad("metre.stl")},
                {"inch.stl", "carries no unit", "8 x 8 x 8 mm if in mm", "203.2 x 203.2 x 203.2 mm if in in",
                 "--unit", "nothing was written"});
  MakeBench();
  ExpectFailure({"add", layout_, Cad("metre.stl")}, {"carries no unit", "300 x 300 x 300 mm if in m"});
  Json({"new", (folder_ / "bench/inches.toml").string(), Cad("inch.stl"), Cad("inch.stl"), "--unit", "in"});
  const nlohmann::json json = Json({"show", (folder_ / "bench/inches.toml").string()});
  EXPECT_EQ(json["parts"][1]["name"], "inch_2");
  EXPECT_NEAR(json["parts"][1]["size_mm"][0].get<double>(), 203.2, kSinglePrecisionMm);
}

TEST_F(LayoutCommand, AGapFrom140To240AndBackGivesTheSameFileAndTheSamePlaces) {
  MakeBench();
  const std::string text = ReadText(layout_);
  const nlohmann::json before = Json({"show", layout_});
  Json({"space", layout_, "gap", "--initial", "240"});
  const nlohmann::json opened = Json({"show", layout_});
  EXPECT_NEAR(opened["spacings"][0]["gap_mm"].get<double>(), 240.0, kSinglePrecisionMm);
  Json({"space", layout_, "gap", "--initial", "140"});
  EXPECT_EQ(ReadText(layout_), text);
  EXPECT_EQ(Json({"show", layout_})["parts"], before["parts"]);
  EXPECT_NE(opened["parts"], before["parts"]);
}

TEST_F(LayoutCommand, WhatTheAuthorWroteStays) {
  const std::string by_hand =
      "# Our bench.\nunit = \"in\" # of all\n\n[[part]] # the box\n  name='box'\n  file = "
      "\"../cad/inch.stl\"\n"
      "# remember the lid\n\n# That's all.\n";
  test_support::WriteText(layout_, by_hand);
  Json({"add", layout_, Cad("metre.stl"), "--unit", "m", "--rotation", "0", "0", "90"});
  EXPECT_EQ(
      ReadText(layout_),
      "# Our bench.\nunit = \"in\" # of all\n\n[[part]] # the box\n  name='box'\n  file = "
      "\"../cad/inch.stl\"\n# remember the lid\n\n[[part]]\nname = \"metre\"\nfile = \"../cad/metre.stl\"\n"
      "unit = \"m\"\nrotation_rpy_deg = [0.0, 0.0, 90.0]\n\n# That's all.\n");
  Json({"remove", layout_, "metre"});
  EXPECT_EQ(ReadText(layout_), by_hand);
  Json({"move", layout_, "box", "--position", "1", "2", "-3"});
  EXPECT_NE(ReadText(layout_).find("inch.stl\"\n  position_mm = [1.0, 2.0, -3.0]\n# remember the lid"),
            std::string::npos)
      << ReadText(layout_);
  Json({"move", layout_, "box", "--position", "-.5", "-.25", "3"});
  EXPECT_NE(ReadText(layout_).find("position_mm = [-0.5, -0.25, 3.0]"), std::string::npos)
      << ReadText(layout_);
}

TEST_F(LayoutCommand, GroupsMoveTogetherAndRulesAreKept) {
  MakeBench();
  Json({"add", layout_, Cad("inch.stl"), "--unit", "in", "--name", "lid", "--position", "0", "0", "600"});
  Json({"group", layout_, "upper", "metre", "lid"});
  Json({"space", layout_, "gap", "--moving", "upper"});
  Json({"pair", layout_, "upper", "box", "--required-clearance", "200"});
  Json({"pair", layout_, "box", "upper", "--authorised-contact"});
  const nlohmann::json json = Json({"show", layout_});
  EXPECT_NEAR(json["spacings"][0]["gap_mm"].get<double>(), 140.0, kSinglePrecisionMm);
  // The lid, 498.4 mm up as it was written, is the lower one.
  EXPECT_NEAR(json["parts"][2]["bounds_mm"][0][2].get<double>(), 101.6 + 140.0, kSinglePrecisionMm);
  ASSERT_EQ(json["pairs"].size(), 1U);
  EXPECT_EQ(json["pairs"][0]["required_clearance_mm"], 200.0);
  EXPECT_EQ(json["pairs"][0]["authorised_contact"], true);
  const ProgramRun clash =
      test_support::RunProgram(test_support::ProgramFile(), {"clash", layout_, "--json"});
  ASSERT_EQ(clash.exit_status, 0) << clash.err;
  const auto judged = nlohmann::json::parse(clash.out)["results"];
  EXPECT_EQ(std::ranges::count_if(judged, [](const auto& pair) { return pair["required_mm"] == 200.0; }), 2);
  Json({"remove", layout_, "--pair", "box", "upper"});
  EXPECT_EQ(Json({"show", layout_})["pairs"].size(), 0U);
}

TEST_F(LayoutCommand, MistakesAreOneLineAndChangeNothing) {
  MakeBench();
  ExpectFailure({"new", layout_}, {"layout.toml", "is there already", "layout add"});
  ExpectFailure({"new", (folder_ / "no/l.toml").string(), Cad("inch.stl"), "--unit", "in"},
                {"/no: no such folder"});
  ExpectFailure({"show", (folder_ / "none.toml").string()}, {"none.toml", "no such layout file"});
  ExpectFailure({"add", layout_, Cad("none.stl"), "--unit", "mm"}, {"none.stl", "no such file"});
  ExpectFailure({"add", layout_, Cad("inch.stl"), "--unit", "mm", "--name", "box"},
                {"two parts are named 'box'"});
  ExpectFailure({"move", layout_, "bix", "--position", "0", "0", "0"}, {"'bix'", "did you mean 'box'?"});
  ExpectFailure({"remove", layout_, "box"}, {"'box' is named by the [[spacing]] in line 12"});
  ExpectFailure({"remove", layout_, "gap", "nobody"}, {"nothing is named 'nobody'"});
  ExpectFailure({"space", layout_, "gap", "--initial", "500"}, {"min_mm <= initial_mm <= max_mm", ":19:"});
  ExpectFailure({"space", layout_, "new", "--moving", "box"}, {"a new one needs --reference"});
  ExpectFailure({"space", layout_, "back", "--moving", "box", "--reference", "metre", "--axis", "x", "--min",
                 "0", "--max", "9", "--initial", "5"},
                {"circular"});
  ExpectFailure({"pair", layout_, "box", "nobody", "--ignore"}, {"names no part: 'nobody'"});
  ExpectFailure({"add", layout_, Cad("inch.stl"), "--unit", "in", "--node", "lid"}, {"'lid' is nothing in"});
  for (const std::vector<std::string>& words : {std::vector<std::string>{},
                                                {"new"},
                                                {"move", layout_, "box"},
                                                {"remove"},
                                                {"add", layout_, Cad("inch.stl"), "--unit", "furlong"},
                                                {"move", layout_, "box", "--position", "1", "2"},
                                                {"space", layout_, "gap", "--axis", "w"},
                                                {"space", layout_, "gap", "--min", "inf"}}) {
    EXPECT_EQ(Run(words).exit_status, 2);
  }
}

TEST_F(LayoutCommand, ALayoutWithoutPartsSaysHowToAddThem) {
  Json({"new", layout_, "--unit", "mm"});
  ExpectFailure({"show", layout_}, {"layout.toml:1: no [[part]]", "layout add"});
}

TEST_F(LayoutCommand, ThePictureShowsThePartsAndTheGap) {
  MakeBench();
  const std::string png = (folder_ / "bench.png").string();
  EXPECT_EQ(Json({"show", layout_, "--picture", png})["picture"], png);
  const cv::Mat picture = cv::imread(png);
  ASSERT_FALSE(picture.empty());
  cv::Mat gap;
  cv::inRange(picture, cv::Scalar(0, 54, 170), cv::Scalar(20, 74, 190), gap);  // BGR of the gap's line
  cv::Rect where = cv::boundingRect(gap);
  EXPECT_GT(cv::countNonZero(gap), 100);
  EXPECT_GT(where.height, 60) << "140 mm of some 640";
  ExpectFailure({"show", layout_, "--picture", "/nowhere/bench.png"}, {"/nowhere/bench.png"});
  ExpectFailure({"show", layout_, "--picture", png + ".jpg"}, {"bench.png.jpg", "ends so"});
}

TEST_F(LayoutCommand, ChangesAtOnceAreAllKept) {
  Json({"new", layout_});
  std::vector<std::jthread> others;
  for (int i = 0; i < 6; ++i)
    others.emplace_back([&, i] {
      EXPECT_EQ(Run({"add", layout_, Cad("inch.stl"), "--unit", "in", "--name", "part " + std::to_string(i)})
                    .exit_status,
                0);
    });
  others.clear();
  EXPECT_EQ(Json({"show", layout_}).at("parts").size(), 6U);
}

TEST_F(LayoutCommand, AMoveSaysWhatAGapSets) {
  MakeBench();
  const ProgramRun run = Run({"move", layout_, "metre", "--position", "0", "0", "900"});
  EXPECT_NE(run.out.find("its z is set by the spacing 'gap'"), std::string::npos) << run.out;
  EXPECT_EQ(Run({"move", layout_, "box", "--position", "0", "0", "900"}).out.find("is set by the spacing"),
            std::string::npos);
}

TEST_F(LayoutCommand, AnImportDoesNotWriteOverItsInput) {
  const std::string file = Cad("inch.stl"), before = ReadText(file);
  const ProgramRun run =
      test_support::RunProgram(test_support::ProgramFile(), {"import", file, "--unit", "in", "--out", file});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("is the file that is read"), std::string::npos) << run.err;
  EXPECT_EQ(ReadText(file), before);
}

TEST_F(LayoutCommand, AnImportListsTheNodesThatALayoutTakes) {
  const std::string assembly =
      (test_support::SharedDataFolder() / "cad/step/ap203_ap214/as1-oc-214.stp").string();
  const ProgramRun run =
      test_support::RunProgram(test_support::ProgramFile(), {"import", assembly, "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json nodes = nlohmann::json::parse(run.out)["nodes"];
  ASSERT_EQ(nodes.size(), 28U);
  EXPECT_NE(std::ranges::find(nodes, "as1/plate_1"), nodes.end());
  Json({"new", layout_});
  Json({"add", layout_, assembly, "--node", "as1/plate_1"});
  const ProgramRun text = test_support::RunProgram(test_support::ProgramFile(), {"import", assembly});
  EXPECT_NE(text.out.find("\n  as1/plate_1\n"), std::string::npos) << text.out;
}

TEST_F(LayoutCommand, AFileThatIsTooLargeIsRefusedUnread) {
  const std::string file = (folder_ / "sparse.stl").string();
  test_support::WriteText(file, "");
  std::filesystem::resize_file(file, std::uintmax_t{200} << 30U);
  const ProgramRun run =
      test_support::RunProgram(test_support::ProgramFile(), {"import", file, "--unit", "mm"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("larger than 1 GiB"), std::string::npos) << run.err;
}

TEST_F(LayoutCommand, ATrialRecordsGroupsAndASweepMovesThemAsOne) {
  MakeBench();
  (void)test_support::WriteBallRig(folder_ / "bench");
  test_support::WriteText(folder_ / "bench/trial.toml", "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n");
  Json({"add", layout_, Cad("metre.stl"), "--unit", "m", "--name", "lid", "--position", "10", "0", "1300"});
  Json({"group", layout_, "upper", "metre", "lid"});
  Json({"space", layout_, "gap", "--moving", "upper"});
  const std::string recorded = (folder_ / "s.db").string();
  const ProgramRun run = test_support::RunProgram(
      test_support::ProgramFile(),
      {"trial", "run", (folder_ / "bench/trial.toml").string(), "--session", recorded, "--headless"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const core::Layout layout = sessions::SessionReader(recorded).header().layout;
  ASSERT_EQ(layout.groups.size(), 1U);
  EXPECT_EQ(layout.groups[0].parts, std::vector<std::string>({"metre", "lid"}));
  EXPECT_EQ(layout.spacings[0].moving, "upper");
  const ProgramRun sweep = test_support::RunProgram(
      test_support::ProgramFile(),
      {"sweep", recorded, "--spacing", "gap=140:240:50", "--out", (folder_ / "sweep").string(), "--json"});
  ASSERT_EQ(sweep.exit_status, 0) << sweep.err;
  EXPECT_EQ(nlohmann::json::parse(sweep.out).at("moved"), nlohmann::json({"metre", "lid"})) << sweep.out;
}

}  // namespace
}  // namespace elbowroom
