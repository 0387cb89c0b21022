#include "app/control/study/study_sessions.h"

#include <vector>

#include "core/procedure/answers.h"
#include "core/procedure/step_runs.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

StudySession ReadStudySession(const std::filesystem::path& path, const std::stop_token& stop) {
  const sessions::SessionReader session(path, stop);
  const core::TrialInfo& trial = session.header().trial;
  const std::vector<core::SessionEvent> events = session.events();
  StudySession read;
  read.path = path;
  read.has_code = !trial.participant.empty();
  read.participant = read.has_code ? trial.participant : path.stem().string();
  read.condition = trial.condition;
  read.order = trial.order;
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
  return read;
}

std::optional<double> NeededMm(const review::SpacingCurve& curve) {
  return curve.frames > 0 ? curve.smallest_free_mm : std::nullopt;
}

}  // namespace elbowroom::control
