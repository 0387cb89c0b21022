#include "sessions/after_trial.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/procedure/answers.h"
#include "core/procedure/scores.h"
#include "core/procedure/step_runs.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using core::AskedWhen;
using sessions::AddAfterTrial;
using sessions::SessionReader;
using test_support::TemporaryFolder;

const std::vector<core::EventContent> kSaid = {
    core::EstimateGiven{AskedWhen::kAfter, 1000.0 / 3.0},
    core::SurveyAnswered{AskedWhen::kAfter, "How sure?", -1},
    core::QuestionnaireAnswered{AskedWhen::kAfter, "presence; DROP", "sick", "severe"},
    core::Note{"it was warm"}};

TEST(AfterTrial, WhatIsSaidComesLastWithTheLastFrame) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 8);
  const std::vector<core::SessionEvent> before = SessionReader(folder / "s.db").events();
  AddAfterTrial(folder / "s.db", kSaid);
  const SessionReader reader(folder / "s.db");
  const std::vector<core::SessionEvent> after = reader.events();
  ASSERT_EQ(after.size(), before.size() + kSaid.size());
  EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin()));
  for (std::size_t i = 0; i < kSaid.size(); ++i)
    EXPECT_EQ(after[before.size() + i], (core::SessionEvent{7, 7 / 30.0, kSaid[i]}));
  EXPECT_EQ(core::EstimatesOf(reader.header().trial, after).after_mm, 1000.0 / 3.0);
  EXPECT_EQ(core::AnswersOf(reader.header().trial, after), (std::vector<std::optional<int>>{6, -1, {}}));
  EXPECT_EQ(reader.status(), sessions::SessionStatus::kComplete);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.db-wal")) << "a session that has ended is one file";
}

TEST(AfterTrial, AWrongAnswerAddsNothing) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 8);
  std::vector<core::EventContent> said = kSaid;
  said.emplace_back(core::SurveyAnswered{AskedWhen::kAfter, "How sure?", 4});
  EXPECT_THROW(AddAfterTrial(folder / "s.db", said), core::PreconditionError);
  EXPECT_EQ(SessionReader(folder / "s.db").events(), SampleEvents());
}

TEST(AfterTrial, AnAnswerThatAQuestionCantHaveAddsNothing) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 8);
  const auto expect_refused = [&](const std::string& name, const std::string& item, core::ItemAnswer answer) {
    std::vector<core::EventContent> said = kSaid;
    said.emplace_back(core::QuestionnaireAnswered{AskedWhen::kAfter, name, item, std::move(answer)});
    EXPECT_THROW(AddAfterTrial(folder / "s.db", said), core::PreconditionError) << item;
  };
  expect_refused("presence; DROP", "there", 8.0);
  expect_refused("presence; DROP", "there", 6.5);
  expect_refused("presence; DROP", "there", "six");
  expect_refused("presence; DROP", "sick", "very");
  expect_refused("presence; DROP", "nowhere", 1.0);
  expect_refused("ability", "turned", 1.0);  // it is asked before
  EXPECT_EQ(SessionReader(folder / "s.db").events(), SampleEvents());
}

TEST(AfterTrial, ATrialThatIsBeingRecordedIsLeftAlone) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  sessions::SessionWriter writer(folder / "s.db", header);
  writer.Append(SampleFrame(header, 0, 1));
  ExpectError([&] { AddAfterTrial(folder / "s.db", kSaid); }, core::ErrorKind::kFile,
              "is being recorded; what is said after the trial can be added when the trial has ended");
}

void ExpectSameScores(const SessionReader& reader, SQLite::Database& database) {
  SQLite::Statement questions(database, "SELECT item, answer, value FROM v_question");
  SQLite::Statement scores(database, "SELECT score, value FROM v_score");
  for (const core::Questionnaire& questionnaire : reader.header().trial.questionnaires) {
    const core::ItemAnswers answers = core::AnswersOf(questionnaire, reader.events());
    for (std::size_t i = 0; i < answers.size(); ++i) {
      ASSERT_TRUE(questions.executeStep());
      EXPECT_EQ(questions.getColumn(0).getString(), questionnaire.items[i].id);
      EXPECT_EQ(questions.getColumn(1).isNull(), !answers[i]);
      const auto value = answers[i] ? core::ValueOf(questionnaire.items[i], *answers[i]) : std::nullopt;
      EXPECT_EQ(questions.getColumn(2).isNull(), !value);
      EXPECT_EQ(questions.getColumn(2).getDouble(), value.value_or(0.0));
    }
    for (const core::Score& score : questionnaire.scores) {
      ASSERT_TRUE(scores.executeStep());
      EXPECT_EQ(scores.getColumn(0).getString(), score.name);
      const auto value = core::ScoreOf(questionnaire, score, answers);
      EXPECT_EQ(scores.getColumn(1).isNull(), !value) << score.name;
      EXPECT_DOUBLE_EQ(scores.getColumn(1).getDouble(), value.value_or(0.0)) << score.name;
    }
  }
  EXPECT_FALSE(questions.executeStep());
  EXPECT_FALSE(scores.executeStep());
}

// The tables' views, asked by another program, say what the values say.
TEST(AfterTrial, TheViewsSayTheSame) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 8);
  AddAfterTrial(folder / "s.db", kSaid);
  const SessionReader reader(folder / "s.db");
  SQLite::Database database((folder / "s.db").string());
  const std::vector<core::StepRun> runs = core::StepRunsOf(reader.events());
  SQLite::Statement steps(database,
                          "SELECT step, begin_frame, begin_time_s, end_frame, end_time_s FROM v_step");
  for (const core::StepRun& run : runs) {
    ASSERT_TRUE(steps.executeStep());
    EXPECT_EQ(steps.getColumn(0).getString(), run.step);
    EXPECT_EQ(steps.getColumn(1).getInt64(), run.begin_frame);
    EXPECT_EQ(steps.getColumn(2).getDouble(), run.begin_s);
    EXPECT_EQ(steps.getColumn(3).isNull(), !run.end_frame);
    EXPECT_EQ(steps.getColumn(4).getDouble(), run.end_s.value_or(0.0));
  }
  EXPECT_FALSE(steps.executeStep());
  const auto ask = [&](const char* sql) { return database.execAndGet(sql).getString(); };
  EXPECT_EQ(
      ask("SELECT group_concat(coalesce(answer, '-')) FROM (SELECT * FROM v_answer ORDER BY item_index)"),
      "6,-1,-");
  EXPECT_EQ(ask("SELECT group_concat(asked || round(estimate_mm)) FROM v_estimate"),
            "before140.0,after333.0");
  EXPECT_EQ(ask("SELECT count(*) FROM v_event WHERE what IS NULL"), "0");
  ExpectSameScores(reader, database);
}

}  // namespace
}  // namespace elbowroom::tests
