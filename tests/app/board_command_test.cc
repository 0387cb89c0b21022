// `elbowroom board`: a page that is written whole, and one line for what can't be.
#include <gtest/gtest.h>

#include <algorithm>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;

class BoardCommand : public testing::Test {
 protected:
  // With `--out` at the end.
  [[nodiscard]] ProgramRun Run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "board");
    arguments.insert(arguments.end(), {"--out", Out()});
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }
  [[nodiscard]] std::string Out() const { return (folder_ / "board.pdf").string(); }

  test_support::TemporaryFolder folder_;
};

TEST_F(BoardCommand, WritesAPageAndSaysWhatCalibTomlNeeds) {
  const ProgramRun run = Run({"charuco", "--columns", "5", "--rows", "7", "--square", "30", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["type"], "charuco");
  EXPECT_EQ(json["marker_mm"], 22.5);
  EXPECT_EQ(json["dictionary"], "DICT_5X5_250");
  EXPECT_EQ(json["layout"], "current");
  EXPECT_EQ(json["points"], 24);
  EXPECT_EQ(json["paper"], "A4");
  EXPECT_EQ(json["page_mm"][1], 297.0);
  EXPECT_NE(json["toml"].get<std::string>().find("marker_mm = 22.5"), std::string::npos);
  const std::string pdf = test_support::ReadText(Out());
  EXPECT_TRUE(pdf.starts_with("%PDF"));
  EXPECT_NE(pdf.find("%%EOF"), std::string::npos);
}

TEST_F(BoardCommand, WritesEveryKind) {
  for (const char* kind : {"chessboard", "charuco", "apriltag", "circles", "circles_asymmetric"}) {
    const ProgramRun run = Run({kind, "--columns", "4", "--rows", "5", "--square", "25", "--inverted"});
    EXPECT_EQ(run.exit_status, 0) << kind << run.err;
    EXPECT_NE(run.out.find("inverted = true"), std::string::npos) << run.out;
  }
}

TEST_F(BoardCommand, RefusesBoardsThatCanNotBeInOneLine) {
  struct Case {
    std::vector<std::string> arguments;
    std::string says;
  };
  const Case cases[] = {
      {{"chessboard", "--columns", "6", "--rows", "6", "--square", "20"}, "quarter turn"},
      {{"chessboard", "--columns", "1", "--rows", "6", "--square", "20"}, "columns and rows are 1 and 6"},
      {{"chessboard", "--columns", "8", "--rows", "5", "--square", "20", "--marker", "9"}, "--marker"},
      {{"circles", "--columns", "8", "--rows", "5", "--square", "20", "--layout", "legacy"}, "--layout"},
      {{"charuco", "--columns", "5", "--rows", "7", "--square", "20", "--marker", "20"}, "marker_mm is 20"},
      {{"charuco", "--columns", "5", "--rows", "7", "--square", "20", "--dictionary", "DICT_9"}, "DICT_9"},
      {{"charuco", "--columns", "12", "--rows", "12", "--square", "20", "--dictionary", "DICT_4X4_50"},
       "72 markers"},
      {{"chessboard", "--columns", "8", "--rows", "5", "--square", "2e4"}, "square_mm"},
  };
  for (const Case& refused : cases) {
    const ProgramRun run = Run(refused.arguments);
    EXPECT_EQ(run.exit_status, 1) << refused.says;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(refused.says), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(Out()));
  }
}

TEST_F(BoardCommand, WrongUsageExitsWithTwo) {
  EXPECT_EQ(Run({"hexagons", "--columns", "4", "--rows", "5", "--square", "25"}).exit_status, 2);
  EXPECT_EQ(Run({"chessboard", "--rows", "5", "--square", "25"}).exit_status, 2);
  EXPECT_EQ(Run({"chessboard", "--columns", "x", "--rows", "5", "--square", "25"}).exit_status, 2);
  EXPECT_EQ(Run({"chessboard", "--columns", "4", "--rows", "5", "--square", "-25"}).exit_status, 2);
}

TEST_F(BoardCommand, NeedsAPlaceForAPdf) {
  const std::vector<std::string> board{"board",  "chessboard", "--columns", "8",
                                       "--rows", "5",          "--square",  "20"};
  for (const std::string& out :
       {(folder_ / "board.png").string(), (folder_ / "nowhere" / "board.pdf").string()}) {
    std::vector<std::string> arguments = board;
    arguments.insert(arguments.end(), {"--out", out});
    const ProgramRun run = test_support::RunProgram(test_support::ProgramFile(), arguments);
    EXPECT_EQ(run.exit_status, 1) << out;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
}

}  // namespace
}  // namespace elbowroom
