// elbowroom touches as a reviewer runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/sessions/sample_trial.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;
using ::testing::HasSubstr;

class TouchesCommand : public testing::Test {
 protected:
  void SetUp() override { tests::WriteTrial(folder_ / "s.db", tests::UsualTrial()); }
  [[nodiscard]] ProgramRun Touches(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"touches", (folder_ / "s.db").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }
  [[nodiscard]] nlohmann::json Json(std::vector<std::string> more) const {
    more.emplace_back("--json");
    const ProgramRun run = Touches(more);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return nlohmann::json::parse(run.out);
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(TouchesCommand, ListsAndSets) {
  const auto listed = Json({});
  ASSERT_EQ(listed["touches"].size(), 7U);
  EXPECT_EQ(listed["counts"]["new"], 7);
  const std::string id = listed["touches"][2]["id"];
  const auto set =
      Json({"set", id.substr(0, 10), "1", "--status", "approved", "--comment", "=cmd| <b>", "--by", "Ann"});
  EXPECT_EQ(set["changed"].size(), 2U);
  const auto after = Json({});
  EXPECT_EQ(after["counts"]["approved"], 2);
  EXPECT_EQ(after["touches"][2]["status"], "approved");
  const auto& said = after["touches"][2]["comments"][0];
  EXPECT_EQ(said["comment"], "=cmd| <b>");
  EXPECT_EQ(said["by"], "Ann");
  EXPECT_THAT(said["at_utc"].get<std::string>(), HasSubstr("Z"));
  EXPECT_EQ(Json({"--status", "approved"})["touches"].size(), 2U);
  EXPECT_THAT(Touches({}).out, HasSubstr("5 new, 2 approved"));
}

TEST_F(TouchesCommand, SaysSomethingWithoutAStatus) {
  (void)Json({"set", "touch 3", "--comment", "ask the cable team"});
  const auto after = Json({});
  EXPECT_EQ(after["counts"]["new"], 7);
  EXPECT_THAT(Touches({}).out, HasSubstr("ask the cable team"));
}

TEST_F(TouchesCommand, RefusesInOneLineAndChangesNothing) {
  for (const auto& arguments : {std::vector<std::string>{"set", "99", "--status", "new"},
                                std::vector<std::string>{"set", "1", "99", "--status", "approved"},
                                std::vector<std::string>{"set", "1", "--status", "new", "--by", ""}}) {
    const ProgramRun run = Touches(arguments);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  }
  EXPECT_EQ(Json({})["counts"]["new"], 7);
  EXPECT_EQ(Touches({"set", "1"}).exit_status, 2) << "neither a status nor a comment";
  EXPECT_EQ(Touches({"set", "--status", "new"}).exit_status, 2) << "no touch";
  EXPECT_EQ(Touches({"set", "1", "--status", "fine"}).exit_status, 2);
}

}  // namespace
}  // namespace elbowroom
