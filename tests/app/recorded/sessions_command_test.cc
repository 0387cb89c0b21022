// elbowroom sessions as a user runs it.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;
using ::testing::HasSubstr;

class SessionsCommand : public testing::Test {
 protected:
  void SetUp() override { tests::WriteTrial(folder_ / "s.db", tests::UsualTrial()); }
  [[nodiscard]] static ProgramRun Sessions(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "sessions");
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }
  [[nodiscard]] std::string In(const char* name) const { return (folder_ / name).string(); }
  test_support::TemporaryFolder folder_;
};

TEST_F(SessionsCommand, Shows) {
  const ProgramRun run = Sessions({"show", In("s.db"), "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto session = nlohmann::json::parse(run.out)["sessions"][0];
  EXPECT_EQ(session["status"], "complete");
  EXPECT_EQ(session["touches"], 7);
  EXPECT_EQ(session["frames"], 620);
  EXPECT_EQ(session["origin"]["file"], "first/O'Hara.db");
  EXPECT_EQ(session["review"]["statuses"]["new"], 7);
  EXPECT_THAT(Sessions({"show", In("s.db")}).out, HasSubstr("7 touches"));
}

TEST_F(SessionsCommand, CheckFailsWhereOneIsNotSound) {
  EXPECT_EQ(Sessions({"check", In("s.db")}).exit_status, 0);
  std::filesystem::copy_file(In("s.db"), In("t.db"));
  SQLite::Database(In("t.db"), SQLite::OPEN_READWRITE)
      .exec("DELETE FROM frame_spacing WHERE frame_index = 3");
  const ProgramRun run = Sessions({"check", In("s.db"), In("t.db"), "--json"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("t.db"));
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["sound"], false);
  EXPECT_EQ(json["sessions"][0]["sound"], true);
  EXPECT_EQ(json["sessions"][1]["sound"], false);
}

TEST_F(SessionsCommand, Exports) {
  const ProgramRun run =
      Sessions({"export", In("s.db"), "--out", In("out"), "--tables", "v_episode,event", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["tables"][0]["rows"], 7);
  for (const auto& file : json["files"])
    EXPECT_TRUE(std::filesystem::exists(file.get<std::string>())) << file;
  EXPECT_EQ(Sessions({"export", In("s.db"), "--out", In("out"), "--tables", "nothing"}).exit_status, 1);
}

TEST_F(SessionsCommand, Merges) {
  tests::WriteSampleSession(folder_ / "t.db", 3);
  const ProgramRun run = Sessions({"merge", In("s.db"), In("t.db"), "--out", In("m.db"), "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["sessions"].size(), 2U);
  EXPECT_EQ(SQLite::Database(In("m.db")).execAndGet("SELECT count(*) FROM session").getInt(), 2);
  const ProgramRun again = Sessions({"merge", In("s.db"), "--out", In("m.db")});
  EXPECT_EQ(again.exit_status, 1);
  EXPECT_THAT(again.err, HasSubstr("exists already"));
}

}  // namespace
}  // namespace elbowroom
