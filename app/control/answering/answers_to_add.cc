#include "app/control/answering/answers_to_add.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <variant>

#include "core/error.h"
#include "core/procedure/answers.h"
#include "core/procedure/scores.h"
#include "core/spelling.h"
#include "sessions/after_trial.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {
namespace {

using core::AskedWhen;
using core::Error;
using core::ErrorKind;

// An item that can be answered: its place in the trial, and its answer so far.
struct AskedItem {
  AskedWhen when = AskedWhen::kAfter;
  std::string questionnaire;     // empty: of the survey
  core::QuestionnaireItem item;  // of the survey: its words as id and text
  std::optional<core::ItemAnswer> answer;

  [[nodiscard]] std::string Name() const {
    return questionnaire.empty() ? item.id : questionnaire + ":" + item.id;
  }
  [[nodiscard]] core::EventContent With(const core::ItemAnswer& given) const {
    if (questionnaire.empty())
      return core::SurveyAnswered{when, item.id, static_cast<int>(std::get<double>(given))};
    return core::QuestionnaireAnswered{when, questionnaire, item.id, given};
  }
};

[[noreturn]] void Fail(const GivenAnswer& given, const std::string& what) {
  throw Error(ErrorKind::kRange, fmt::format("{}: {}", given.where, what));
}

std::vector<AskedItem> ItemsOf(const core::TrialInfo& trial, std::span<const core::SessionEvent> events) {
  std::vector<AskedItem> items;
  const auto answers = core::AnswersOf(trial, events);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const core::SurveyItem& asked = trial.survey[i];
    core::QuestionnaireItem item{asked.item, asked.item};
    item.least = asked.least;
    item.most = asked.most;
    std::optional<core::ItemAnswer> said;
    if (answers[i]) said = static_cast<double>(*answers[i]);
    items.push_back({asked.when, "", std::move(item), std::move(said)});
  }
  for (const core::Questionnaire& questionnaire : trial.questionnaires) {
    const core::ItemAnswers said = core::AnswersOf(questionnaire, events);
    for (std::size_t i = 0; i < said.size(); ++i)
      items.push_back({questionnaire.when, questionnaire.name, questionnaire.items[i], said[i]});
  }
  return items;
}

// A session that answers can be added to.
struct AskedSession {
  core::TrialInfo trial;
  std::vector<AskedItem> items;
  SessionAnswers answers;
  std::map<const AskedItem*, std::string> given = {};  // where
};

AskedSession ReadSession(const std::filesystem::path& path, const std::stop_token& stop) {
  const sessions::SessionReader reader(path, stop);
  const auto fail = [&](const char* what) {
    throw Error(ErrorKind::kRange, fmt::format("session '{}' {}", path.string(), what));
  };
  if (reader.frame_count() == 0) fail("has no frame; nothing can be added to it");
  if (reader.status() == sessions::SessionStatus::kRecording)
    fail("is being recorded; answers can be added when the trial has ended");
  const core::TrialInfo& trial = reader.header().trial;
  return {trial, ItemsOf(trial, reader.events()), {path, trial.participant, {}}};
}

bool IsMeant(const AskedSession& session, const GivenAnswer& given) {
  const auto is = [](const std::string& said, const std::string& has) { return said.empty() || said == has; };
  const std::filesystem::path& path = session.answers.session;
  return (is(given.session, path.filename().string()) || is(given.session, path.stem().string())) &&
         is(given.participant, session.trial.participant) && is(given.condition, session.trial.condition) &&
         is(given.order, std::to_string(session.trial.order)) && is(given.block, session.trial.block);
}

AskedSession& SessionOf(const GivenAnswer& given, std::vector<AskedSession>* sessions) {
  AskedSession* found = nullptr;
  for (AskedSession& session : *sessions) {
    if (!IsMeant(session, given)) continue;
    if (found != nullptr)
      Fail(given, fmt::format("fits '{}' and '{}'; tell them apart by a column session, order, condition or "
                              "block",
                              found->answers.session.string(), session.answers.session.string()));
    found = &session;
  }
  if (found == nullptr)
    Fail(given, fmt::format("is of {}, and no session given is; correct it, or give its session",
                            given.participant.empty() ? "another session"
                                                      : fmt::format("participant '{}'", given.participant)));
  return *found;
}

bool IsMeant(const AskedItem& asked, const GivenAnswer& given) {
  return (given.phase.empty() || given.phase == core::ToString(asked.when)) &&
         (given.questionnaire.empty() || given.questionnaire == asked.questionnaire) &&
         (given.item == asked.item.id || given.item == asked.Name());
}

const AskedItem& ItemOf(const GivenAnswer& given, const AskedSession& session) {
  if (!given.phase.empty() && !core::ParseAskedWhen(given.phase))
    Fail(given, fmt::format("the phase is '{}'; it must be before or after", given.phase));
  const AskedItem* found = nullptr;
  std::vector<std::string> names;
  for (const AskedItem& asked : session.items) {
    names.push_back(asked.item.id);
    if (!IsMeant(asked, given)) continue;
    if (found != nullptr)
      Fail(given,
           fmt::format("'{}' is asked more than once; say the phase and the questionnaire", given.item));
    found = &asked;
  }
  if (found == nullptr)
    Fail(given,
         fmt::format(
             "session '{}' has no item '{}'{}; {}", session.answers.session.string(), given.item,
             given.phase.empty() && given.questionnaire.empty() ? "" : " of that phase and questionnaire",
             core::SpellingAdvice(given.item, names, "'sessions show --json' lists them")));
  return *found;
}

void Take(const GivenAnswer& given, AskedSession* session) {
  const AskedItem& asked = ItemOf(given, *session);
  if (const auto [before, is_first] = session->given.emplace(&asked, given.where); !is_first)
    Fail(given, fmt::format("'{}' is answered by {} already; leave one out", given.item, before->second));
  if (given.answer.empty()) {
    ++session->answers.empty;
    return;
  }
  const auto answer = core::ParseAnswer(asked.item, given.answer);
  if (!answer)
    Fail(given, fmt::format("'{}' can't be the answer to '{}'; it must be {}", given.answer, given.item,
                            core::AnswersInWords(asked.item)));
  if (asked.answer == answer)
    ++session->answers.unchanged;
  else
    session->answers.to_add.push_back(asked.With(*answer));
}

}  // namespace

std::vector<SessionAnswers> MatchAnswers(std::span<const std::filesystem::path> sessions,
                                         std::span<const GivenAnswer> given, const std::stop_token& stop) {
  std::vector<AskedSession> read;
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& path : sessions) {
    std::error_code unknown;
    if (!seen.insert(std::filesystem::weakly_canonical(path, unknown)).second)
      throw Error(ErrorKind::kRange,
                  fmt::format("session '{}' is given twice; leave one out", path.string()));
    read.push_back(ReadSession(path, stop));
  }
  for (const GivenAnswer& answer : given) Take(answer, &SessionOf(answer, &read));
  std::vector<SessionAnswers> answers;
  for (AskedSession& session : read) answers.push_back(std::move(session.answers));
  return answers;
}

void AddAnswers(std::span<const SessionAnswers> answers) {
  bool is_first = true;
  for (const SessionAnswers& of_session : answers) {
    if (of_session.to_add.empty()) continue;
    try {
      sessions::AddAfterTrial(of_session.session, of_session.to_add);
    } catch (const Error& error) {
      if (is_first) throw;
      throw Error(error.kind(),
                  fmt::format("{}; the sessions before it have their answers: put this right and give the "
                              "command again, nothing is added twice",
                              error.what()));
    }
    is_first = false;
  }
}

}  // namespace elbowroom::control
