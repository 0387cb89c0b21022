// What one recorded session says of its participant.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/control/sweep/spacing_sweep.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// A measure's name and its value in the session: "trial_s" of frames, "touches", "step_s:NAME" of all runs of
// a step that ended, "answer:ITEM" of the survey after the trial, "score:QUESTIONNAIRE:SCORE" of a
// questionnaire after it and "score_before:QUESTIONNAIRE:SCORE" of one before it, "needed_mm",
// "needed_without_tools_mm", "shortfall_mm": what is needed less what was estimated before.
using Measures = std::map<std::string, double>;

// The smallest gap at which, as at all above, surely nothing touches in some frames. No length: there are no
// such frames, or it lies beyond the gaps that were tried.
struct NeededGap {
  std::optional<double> gap_mm = {};
  bool is_above = false;  // the largest gap tried was touched
  bool is_below = false;  // the smallest gap tried was free, and there are smaller ones
};

// `least_mm`: the smallest gap that there is.
[[nodiscard]] NeededGap NeededGapOf(const review::SpacingCurve& curve, double least_mm);

struct StudySession {
  std::filesystem::path path;
  std::string recording_id;
  std::string participant;  // the code that the trial gives; without one the file's name
  bool has_code = true;
  bool is_simulated = false;
  std::string task;        // empty: not given
  std::string condition;   // empty: none
  int order = 0;           // among the participant's trials; 0: not given
  std::string block = {};  // to which part of the study it belongs; empty: none
  std::string started_at_utc;
  std::optional<double> estimate_before_mm;
  std::optional<double> estimate_after_mm;
  NeededGap needed = {};
  NeededGap needed_without_tools = {};  // in the frames in which none was marked in use
  Measures measures;

  [[nodiscard]] std::optional<double> Measured(const std::string& measure) const;
};

// All but what a sweep finds. Throws: as sessions::SessionReader.
[[nodiscard]] StudySession ReadStudySession(const sessions::SessionReader& session);

// A session without a code is a participant of its own: where the name of its file is another's too, the
// recording's number is added to it.
void NameParticipantsApart(std::vector<StudySession>* sessions);

// What a sweep found of the session, and its measures.
void AddNeeds(const SweptSession& swept, double least_mm, StudySession* session);

}  // namespace elbowroom::control
