// elbowroom sessions show|check|export|merge|answer: look into sessions, verify them, tables out, several
// into one, answers from paper in.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/recorded/session_summary.h"
#include "app/control/answering/answer_table.h"
#include "app/control/answering/answers_to_add.h"
#include "app/control/outcome_tracker.h"
#include "sessions/archive/session_check.h"
#include "sessions/archive/session_merge.h"
#include "sessions/archive/table_export.h"

namespace elbowroom::cli {
namespace {

struct SessionsOptions {
  std::vector<std::filesystem::path> sessions;
  std::filesystem::path out;
  std::vector<std::string> tables;
  std::filesystem::path csv;         // of answers; empty: none
  std::vector<std::string> answers;  // ITEM=ANSWER
};

CommandResult Show(const SessionsOptions& options, const CommandContext& context) {
  CommandResult result;
  result.json["sessions"] = nlohmann::json::array();
  for (const std::filesystem::path& path : options.sessions) {
    const nlohmann::json summary =
        SummaryJson(control::OpenWithOutcome(path, context.progress, context.stop));
    result.text += (result.text.empty() ? "" : "\n") + SummaryText(summary);
    result.json["sessions"].push_back(summary);
  }
  return result;
}

nlohmann::json CheckJson(const sessions::SessionCheck& check) {
  nlohmann::json gaps = nlohmann::json::array();
  for (const sessions::FrameGap& gap : check.gaps) gaps.push_back({gap.first, gap.end});
  return {{"session", check.session.string()},
          {"sound", check.is_sound()},
          {"problems", check.problems},
          {"notes", check.notes},
          {"status", check.schema > 0 ? nlohmann::json(sessions::ToString(check.status)) : nlohmann::json()},
          {"schema", check.schema > 0 ? nlohmann::json(check.schema) : nlohmann::json()},
          {"frames", check.frames},
          {"gaps", gaps},
          {"silhouettes", check.silhouettes},
          {"meshes", check.meshes},
          {"footage_files", check.footage_files}};
}

std::string CheckText(const sessions::SessionCheck& check) {
  const std::string name = check.session.string();
  std::string text = check.is_sound()
                         ? fmt::format("{}: sound; {} frames without a gap, {} silhouettes, {} meshes", name,
                                       check.frames, check.silhouettes, check.meshes)
                         : fmt::format("{}: not sound", name);
  if (check.is_sound() && check.footage_files > 0)
    text += fmt::format(", {} files of footage", check.footage_files);
  for (const std::string& problem : check.problems) text += "\n  " + problem;
  for (const std::string& note : check.notes) text += "\n  note: " + note;
  return text;
}

CommandResult Check(const SessionsOptions& options, const CommandContext& context) {
  CommandResult result;
  result.json["sessions"] = nlohmann::json::array();
  std::size_t not_sound = 0;
  std::string first_problem;
  for (const std::filesystem::path& path : options.sessions) {
    const sessions::SessionCheck check = sessions::CheckSession(path, context.progress, context.stop);
    if (!check.is_sound() && not_sound++ == 0) first_problem = check.problems.front();
    result.text += (result.text.empty() ? "" : "\n") + CheckText(check);
    result.json["sessions"].push_back(CheckJson(check));
  }
  result.json["sound"] = not_sound == 0;
  if (not_sound == 1) result.failure = first_problem;
  if (not_sound > 1)
    result.failure = fmt::format("{} of {} sessions aren't sound; the first: {}", not_sound,
                                 options.sessions.size(), first_problem);
  return result;
}

CommandResult Export(const SessionsOptions& options, const CommandContext& context) {
  CommandResult result;
  result.json = {{"session", options.sessions.front().string()},
                 {"tables", nlohmann::json::array()},
                 {"files", nlohmann::json::array()}};
  for (const sessions::ExportedTable& table : sessions::ExportTables(
           options.sessions.front(), options.tables, options.out, context.progress, context.stop)) {
    result.json["tables"].push_back({{"table", table.name}, {"rows", table.rows}});
    for (const char* ending : {".csv", ".json"})
      result.json["files"].push_back((options.out / (table.name + ending)).string());
    result.text += fmt::format("{:>10} rows  {}\n", table.rows, (options.out / table.name).string());
  }
  result.text += "each as .csv and .json";
  return result;
}

CommandResult Merge(const SessionsOptions& options, const CommandContext& context) {
  CommandResult result;
  result.json = {{"merged", options.out.string()}, {"sessions", nlohmann::json::array()}};
  for (const sessions::MergedSession& session :
       sessions::MergeSessions(options.sessions, options.out, context.progress, context.stop)) {
    result.json["sessions"].push_back({{"session_id", session.session_id},
                                       {"session", session.file.string()},
                                       {"participant", session.participant},
                                       {"recording_id", session.recording_id},
                                       {"first_recording_id", session.first_recording_id},
                                       {"rows", session.rows}});
    result.text +=
        fmt::format("{}: {} rows of {}\n", session.session_id, session.rows, session.file.string());
  }
  result.text += options.out.string();
  return result;
}

CommandResult Answer(const SessionsOptions& options, const CommandContext& context) {
  std::vector<control::GivenAnswer> given;
  if (!options.csv.empty()) given = control::ReadAnswerTable(options.csv);
  for (const std::string& text : options.answers) given.push_back(control::ParseGivenAnswer(text));
  const std::vector<control::SessionAnswers> answers =
      control::MatchAnswers(options.sessions, given, context.stop);
  control::AddAnswers(answers);
  CommandResult result;
  result.json["sessions"] = nlohmann::json::array();
  for (const control::SessionAnswers& of : answers) {
    result.json["sessions"].push_back({{"session", of.session.string()},
                                       {"participant", of.participant},
                                       {"added", of.to_add.size()},
                                       {"unchanged", of.unchanged},
                                       {"empty", of.empty}});
    result.text +=
        fmt::format("{}{}: {} answers added, {} were there, {} left blank", result.text.empty() ? "" : "\n",
                    of.session.string(), of.to_add.size(), of.unchanged, of.empty);
  }
  return result;
}

}  // namespace

void AddSessionsCommand(CLI::App& app, Choice* choice) {
  CLI::App* sessions =
      app.add_subcommand("sessions", "look into session files, verify them, take tables out");
  sessions->require_subcommand(1);
  auto options = std::make_shared<SessionsOptions>();
  using Action = CommandResult (*)(const SessionsOptions&, const CommandContext&);
  const auto add = [=](const char* name, const char* help, Action action) {
    CLI::App* command = sessions->add_subcommand(name, help);
    command->callback(
        [=] { choice->action = [=](const CommandContext& context) { return action(*options, context); }; });
    return command;
  };
  CLI::App* show = add("show", "what is in sessions, in some lines each", Show);
  show->add_option("SESSION", options->sessions, "the sessions (S.db)")->required();

  CLI::App* check =
      add("check", "verify sessions down to every picture; exit status 1 if one isn't sound", Check);
  check->add_option("SESSION", options->sessions, "the sessions (S.db)")->required();

  CLI::App* tables = add("export", "every table and view of a session as CSV and JSON", Export);
  tables->add_option("SESSION", options->sessions, "the session (S.db)")->required()->expected(1);
  tables->add_option("--out", options->out, "folder for the files; made if it isn't there")->required();
  tables->add_option("--tables", options->tables, "only these tables and views")->delimiter(',');

  CLI::App* merge = add("merge", "several sessions in one file, to ask questions across participants", Merge);
  merge->add_option("SESSION", options->sessions, "the sessions (S.db)")->required();
  merge->add_option("--out", options->out, "the new file; must not exist yet")->required();

  CLI::App* answer = add("answer", "add what participants answered on paper to their sessions", Answer);
  answer->add_option("SESSION", options->sessions, "the sessions (S.db)")->required();
  answer->add_option(
      "--csv", options->csv,
      "a table with the columns item and answer, and of session, participant, condition, order, "
      "block, phase, questionnaire what tells sessions and items apart");
  answer->add_option(
      "--give", options->answers,
      "answers as ITEM=ANSWER, [before:|after:][QUESTIONNAIRE:]ITEM=ANSWER where several items "
      "have one name");
  answer->callback([=] {
    if (options->csv.empty() && options->answers.empty())
      throw CLI::RequiredError("--csv FILE or --give ITEM=ANSWER");
    choice->action = [=](const CommandContext& context) { return Answer(*options, context); };
  });
}

}  // namespace elbowroom::cli
