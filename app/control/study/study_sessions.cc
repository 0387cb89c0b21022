#include "app/control/study/study_sessions.h"

#include <cstddef>
#include <set>
#include <vector>

#include "core/procedure/answers.h"
#include "core/procedure/scores.h"
#include "core/procedure/simulated.h"
#include "core/procedure/step_runs.h"

namespace elbowroom::control {
namespace {

// Of all questionnaires of the trial; of those before it under another name, so that both can be asked.
void AddScores(const core::TrialInfo& trial, const std::vector<core::SessionEvent>& events,
               Measures* measures) {
  for (const core::Questionnaire& questionnaire : trial.questionnaires) {
    const core::ItemAnswers answers = core::AnswersOf(questionnaire, events);
    const std::string kind = questionnaire.when == core::AskedWhen::kBefore ? "score_before" : "score";
    for (const core::Score& score : questionnaire.scores)
      if (const auto value = core::ScoreOf(questionnaire, score, answers))
        (*measures)[kind + ":" + questionnaire.name + ":" + score.name] = *value;
  }
}

}  // namespace

std::optional<double> StudySession::Measured(const std::string& measure) const {
  const auto found = measures.find(measure);
  return found == measures.end() ? std::nullopt : std::optional(found->second);
}

StudySession ReadStudySession(const sessions::SessionReader& session) {
  const core::TrialInfo& trial = session.header().trial;
  const std::vector<core::SessionEvent> events = session.events();
  StudySession read;
  read.path = session.path();
  read.recording_id = session.recording_id();
  read.has_code = !trial.participant.empty();
  read.participant = read.has_code ? trial.participant : read.path.stem().string();
  read.is_simulated = core::IsSimulated(events);
  read.task = trial.task;
  read.condition = trial.condition;
  read.order = trial.order;
  read.block = trial.block;
  read.started_at_utc = session.header().started_at_utc;
  const core::Estimates estimates = core::EstimatesOf(trial, events);
  read.estimate_before_mm = estimates.before_mm;
  read.estimate_after_mm = estimates.after_mm;
  if (const auto frames = session.frames(); !frames.empty())
    read.measures["trial_s"] = frames.back().time_s - frames.front().time_s;
  if (session.has_outcome()) read.measures["touches"] = static_cast<double>(session.episodes().size());
  for (const core::StepRun& run : core::StepRunsOf(events))
    if (const auto duration_s = run.duration_s()) read.measures["step_s:" + run.step] += *duration_s;
  const auto answers = core::AnswersOf(trial, events);
  for (std::size_t i = 0; i < answers.size(); ++i)
    if (answers[i] && trial.survey[i].when == core::AskedWhen::kAfter)
      read.measures["answer:" + trial.survey[i].item] = *answers[i];
  AddScores(trial, events, &read.measures);
  return read;
}

void NameParticipantsApart(std::vector<StudySession>* sessions) {
  constexpr std::size_t kDigits = 8;
  std::set<std::string> codes;
  std::map<std::string, std::size_t> files;  // without a code, by name
  for (const StudySession& session : *sessions) {
    if (session.has_code)
      codes.insert(session.participant);
    else
      ++files[session.participant];
  }
  for (StudySession& session : *sessions)
    if (!session.has_code && (files.at(session.participant) > 1 || codes.contains(session.participant)))
      session.participant += " (" + session.recording_id.substr(0, kDigits) + ")";
}

NeededGap NeededGapOf(const review::SpacingCurve& curve, double least_mm) {
  if (curve.frames == 0) return {};
  if (!curve.smallest_free_mm) return {.is_above = true};
  const double first_mm = curve.steps.front().spacing_mm;
  if (*curve.smallest_free_mm <= first_mm && first_mm > least_mm) return {.is_below = true};
  return {.gap_mm = curve.smallest_free_mm};
}

void AddNeeds(const SweptSession& swept, double least_mm, StudySession* session) {
  session->needed = NeededGapOf(swept.curves.all, least_mm);
  session->needed_without_tools = NeededGapOf(swept.curves.without_tools, least_mm);
  if (const auto needed_mm = session->needed.gap_mm) {
    session->measures["needed_mm"] = *needed_mm;
    if (session->estimate_before_mm)
      session->measures["shortfall_mm"] = *needed_mm - *session->estimate_before_mm;
  }
  if (const auto needed_mm = session->needed_without_tools.gap_mm)
    session->measures["needed_without_tools_mm"] = *needed_mm;
}

}  // namespace elbowroom::control
