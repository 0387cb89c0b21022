// elbowroom sessions as a user runs it.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/procedure/answers.h"
#include "core/procedure/scores.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

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

// Sessions that ask what SampleHeader() asks, with nobody's answers yet.
class AnswerCommand : public testing::Test {
 protected:
  std::string Record(const std::string& name, const std::string& participant, int order = 1) {
    core::SessionHeader header = tests::SampleHeader();
    header.trial.participant = participant;
    header.trial.order = order;
    sessions::SessionWriter writer(folder_ / name, header);
    for (core::FrameIndex i = 0; i < 3; ++i) writer.Append(tests::SampleFrame(header, i, 1));
    writer.Finish(tests::SampleOutcome(0, 2));
    return (folder_ / name).string();
  }
  [[nodiscard]] ProgramRun Answer(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"sessions", "answer"});
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }
  [[nodiscard]] std::string Table(const std::string& text) const {
    test_support::WriteText(folder_ / "answers.csv", text);
    return (folder_ / "answers.csv").string();
  }
  [[nodiscard]] static core::ItemAnswers Presence(const std::string& session) {
    const sessions::SessionReader reader(session);
    return core::AnswersOf(reader.header().trial.questionnaires.at(1), reader.events());
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(AnswerCommand, GivesSomeByName) {
  const std::string session = Record("s.db", "P1");
  const ProgramRun run = Answer({session, "--json", "--give", "there=6", "lab=-2", "sick=3",
                                 "ability:turned=12.5", "before:How sure?=4"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["sessions"][0]["added"], 5);
  EXPECT_EQ(Presence(session), (core::ItemAnswers{6.0, -2.0, "severe", {}}));
  const sessions::SessionReader reader(session);
  EXPECT_EQ(core::AnswersOf(reader.header().trial, reader.events())[0], 4);
  const ProgramRun show =
      test_support::RunProgram(test_support::ProgramFile(), {"sessions", "show", session, "--json"});
  const auto shown = nlohmann::json::parse(show.out)["sessions"][0];
  EXPECT_EQ(shown["block"], "timed; DROP");
  EXPECT_EQ(shown["questionnaires"][1]["items"][1]["value"], 2.0) << "reversed";
  EXPECT_EQ(shown["questionnaires"][1]["scores"][0]["value"], 2.0);
  EXPECT_TRUE(shown["questionnaires"][1]["scores"][3]["value"].is_null()) << "'age' isn't answered";
  EXPECT_EQ(test_support::RunProgram(test_support::ProgramFile(), {"sessions", "check", session}).exit_status,
            0);
}

TEST_F(AnswerCommand, ATableIsOfManySessions) {
  const std::string a = Record("a.db", "P1", 1), b = Record("b.db", "P1", 2), c = Record("c.db", "P2");
  const std::string csv = Table(
      "participant,order,phase,questionnaire,item,answer\r\n"
      "P1,1,after,presence; DROP,there,2\r\n"
      "P1,2,after,presence; DROP,there,5\r\n"
      "\r\n"
      "P2,,before,ability,words,\"so, \"\"well\"\"\"\r\n"
      "P2,,after,presence; DROP,sick,None\r\n"
      "P2,,after,presence; DROP,lab,\r\n");
  const ProgramRun run = Answer({a, b, c, "--csv", csv, "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(Presence(a)[0], core::ItemAnswer(2.0));
  EXPECT_EQ(Presence(b)[0], core::ItemAnswer(5.0));
  EXPECT_EQ(Presence(c), (core::ItemAnswers{{}, {}, "none", {}}));
  EXPECT_EQ(nlohmann::json::parse(run.out)["sessions"][2]["empty"], 1);
  const sessions::SessionReader reader(c);
  EXPECT_EQ(core::AnswersOf(reader.header().trial.questionnaires[0], reader.events())[1],
            core::ItemAnswer("so, \"well\""));
  const std::size_t events = reader.events().size();
  const auto again = nlohmann::json::parse(Answer({a, b, c, "--csv", csv, "--json"}).out);
  EXPECT_EQ(again["sessions"][2]["added"], 0) << "nothing is added twice";
  EXPECT_EQ(again["sessions"][2]["unchanged"], 2);
  EXPECT_EQ(sessions::SessionReader(c).events().size(), events);
}

TEST_F(AnswerCommand, OneBadLineAddsNothingAndIsNamed) {
  const std::string a = Record("a.db", "P1", 1), b = Record("b.db", "P1", 2);
  const std::string good = "participant,order,phase,questionnaire,item,answer\nP1,1,after,,there,2\n";
  for (const auto& [lines, said] :
       {std::pair{good + "P1,2,after,,there,8\n",
                  "answers.csv:3: '8' can't be the answer to 'there'; it must be a "
                  "whole number from 1 to 7"},
        std::pair{good + "P1,2,after,,sick,much\n", "it must be 'none' or "},
        std::pair{good + "P1,2,after,,ther,3\n", "did you mean 'there'?"},
        std::pair{good + "P1,2,before,,there,3\n", "has no item 'there' of that phase"},
        std::pair{good + "P1,2,later,,there,3\n", "it must be before or after"},
        std::pair{good + "P1,2,,,How sure?,3\n", "asked more than once"},
        std::pair{good + "P1,,after,,there,3\n", "tell them apart by a column session, order"},
        std::pair{good + "P3,1,after,,there,3\n", "of participant 'P3'"},
        std::pair{good + "P1,1,after,,there,3\n", "is answered by"},
        std::pair{good + "P1,1,after,,there\n", "answers.csv:3: has fewer fields"},
        std::pair{good + "P1,1,after,,there,3,4\n", "has more fields"},
        std::pair{good + "P1,1,after,,words,\"a\n", "doesn't close it"},
        std::pair{good + "P1,1,after,,,3\n", "names no item"},
        std::pair{good + "P1,1,after,,words,\xff\n", "isn't UTF-8"},
        std::pair{std::string("participant,item\nP1,there\n"), "has no column 'answer'"},
        std::pair{std::string("item,answer,partcipant\na,1,P1\n"), "no column is called 'partcipant'"},
        std::pair{std::string("item,answer,item\na,1,b\n"), "has the column 'item' twice"},
        std::pair{std::string("item,answer\n"), "has no answers"},
        std::pair{std::string(), "isn't a table"}}) {
    const ProgramRun run = Answer({a, b, "--csv", Table(lines)});
    EXPECT_EQ(run.exit_status, 1) << lines;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr(said));
    EXPECT_THAT(run.err, HasSubstr("answers.csv"));
    EXPECT_TRUE(sessions::SessionReader(a).events().empty()) << lines;
  }
  EXPECT_THAT(Answer({a, "--give", "there"}).err, HasSubstr("must be ITEM=ANSWER"));
  EXPECT_THAT(Answer({a, a, "--give", "there=3"}).err, HasSubstr("a.db' is given twice"));
  EXPECT_EQ(Answer({a}).exit_status, 2) << "neither a table nor answers";
  EXPECT_EQ(Answer({a, "--csv", "nowhere.csv"}).exit_status, 1);
}

}  // namespace
}  // namespace elbowroom
