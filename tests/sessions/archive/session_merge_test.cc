#include "sessions/archive/session_merge.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sessions/session_reader.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using core::ErrorKind;
using sessions::MergedSession;
using sessions::MergeSessions;

class SessionMerge : public testing::Test {
 protected:
  [[nodiscard]] std::vector<MergedSession> Merge(const std::vector<std::filesystem::path>& sessions) const {
    return MergeSessions(sessions, merged_, {}, {});
  }
  test_support::TemporaryFolder folder_;
  std::filesystem::path a_ = folder_ / "a.db", b_ = folder_ / "b.db", merged_ = folder_ / "merged.db";
};

// Each table's rows of one session, as text, in any order.
std::vector<std::string> RowsOf(SQLite::Database& database, const std::string& sql) {
  SQLite::Statement rows(database, sql);
  std::vector<std::string> texts;
  while (rows.executeStep()) {
    std::string text;
    for (int i = 0; i < rows.getColumnCount(); ++i)
      text += fmt::format("{}:{}|", rows.getColumn(i).getType(),
                          rows.getColumn(i).isFloat() ? fmt::format("{}", rows.getColumn(i).getDouble())
                                                      : rows.getColumn(i).getString());
    texts.push_back(text);
  }
  std::ranges::sort(texts);
  return texts;
}

TEST_F(SessionMerge, HoldsTheRowsOfEachSession) {
  WriteSampleSession(a_, 5);
  WriteTrial(b_, UsualTrial());
  const std::vector<MergedSession> taken = Merge({a_, b_});
  ASSERT_EQ(taken.size(), 2U);
  SQLite::Database merged(merged_.string());
  for (const MergedSession& session : taken) {
    SQLite::Database one(session.file.string());
    SQLite::Statement names(
        one, "SELECT name FROM sqlite_schema WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite_%'");
    std::int64_t rows = 0;
    while (names.executeStep()) {
      const std::string name = names.getColumn(0).getString();
      if (name == "mesh" || name == "mask" || name == "silhouette" || name == "v_silhouette") {
        EXPECT_FALSE(merged.tableExists(name));
        continue;
      }
      std::string columns;
      for (SQLite::Statement column(one, "SELECT name FROM pragma_table_info('" + name + "')");
           column.executeStep();)
        columns += (columns.empty() ? "\"" : ", \"") + column.getColumn(0).getString() + "\"";
      const auto expected = RowsOf(one, fmt::format("SELECT {} FROM \"{}\"", columns, name));
      EXPECT_EQ(RowsOf(merged, fmt::format("SELECT {} FROM \"{}\" WHERE session_id = {}", columns, name,
                                           session.session_id)),
                expected)
          << name;
      rows += std::ssize(expected);
    }
    EXPECT_EQ(session.rows, rows);
  }
}

TEST_F(SessionMerge, AnswersAcrossParticipants) {
  WriteSampleSession(a_, 5);
  WriteTrial(b_, UsualTrial());
  (void)Merge({a_, b_});
  SQLite::Database merged(merged_.string());
  EXPECT_EQ(merged
                .execAndGet("SELECT count(*) FROM (SELECT participant, max(peak_depth_mm) FROM v_episode "
                            "JOIN session USING (session_id) GROUP BY session_id)")
                .getInt(),
            2);
  EXPECT_EQ(merged.execAndGet("SELECT count(*) FROM source WHERE length(content_hash) = 16").getInt(), 2);
}

TEST_F(SessionMerge, RefusesOneSessionTwice) {
  WriteSampleSession(a_, 2);
  std::filesystem::copy_file(a_, b_);
  ExpectError([&] { (void)Merge({a_, b_}); }, ErrorKind::kRange, "the same session");
  EXPECT_FALSE(std::filesystem::exists(merged_));
}

TEST_F(SessionMerge, RefusesOneWithoutItsTouches) {
  TrialPlan plan = UsualTrial();
  plan.is_finished = false;
  WriteTrial(a_, plan);
  ExpectError([&] { (void)Merge({a_}); }, ErrorKind::kRange, "replay");
  EXPECT_FALSE(std::filesystem::exists(merged_));
}

TEST_F(SessionMerge, ReplacesNothing) {
  WriteSampleSession(a_, 2);
  (void)Merge({a_});
  ExpectError([&] { (void)Merge({a_}); }, ErrorKind::kFile, "exists already");
}

TEST_F(SessionMerge, IsToldFromASession) {
  WriteSampleSession(a_, 2);
  (void)Merge({a_});
  ExpectError([&] { sessions::SessionReader{merged_}; }, ErrorKind::kFormat, "holds several sessions");
}

TEST_F(SessionMerge, TakesFilesOfOlderSchemas) {
  const auto stored = test_support::SourceFolder() / "tests/sessions/stored/session_schema_3.db";
  WriteSampleSession(a_, 2);
  const auto taken = Merge({stored, a_});
  EXPECT_GT(taken[0].rows, 0);
}

}  // namespace
}  // namespace elbowroom::tests
