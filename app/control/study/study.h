// What recorded sessions say of their participants: how much space each allocated, and how much was needed.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/study/study_comparisons.h"
#include "app/control/study/study_dwell.h"
#include "app/control/study/study_sessions.h"
#include "app/control/sweep/spacing_sweep.h"
#include "core/progress.h"
#include "core/statistics/summary.h"

namespace elbowroom::control {

// A participant over all sessions, as a row of the paper's Table 3.
struct StudyRow {
  std::string participant;
  std::size_t sessions = 0;
  std::optional<double> estimate_before_mm = {};             // of the first session with one
  std::optional<double> needed_without_tools_mm = {};        // the largest of the sessions
  std::optional<double> needed_mm = {};                      // with the tools that were in use; likewise
  std::optional<double> estimate_after_mm = {};              // of the last session with one
  [[nodiscard]] std::optional<double> shortfall_mm() const;  // needed less estimated before
};

struct Study {
  SpacingRange range;
  std::vector<StudySession> sessions;  // by participant, then as they were made
  std::vector<StudyRow> rows;          // by participant
  // Over the participants who have a shortfall; nothing: none has.
  std::optional<core::Summary> shortfall_mm = {};
  std::optional<core::Interval> shortfall_interval_mm = {};   // of the mean, 95 %, if normally distributed
  std::optional<core::Interval> shortfall_bootstrap_mm = {};  // of the mean, 95 %
  std::string baseline = {};                    // a condition; empty: conditions are compared as they are
  std::vector<BeyondBaseline> beyond = {};      // of that condition
  std::map<std::string, ByCondition> compared;  // what is compared: by measure, beyond the baseline if any
  std::vector<Comparison> comparisons;
  std::vector<MeasuresCorrelated> correlations;
  std::vector<PartDwell> dwell;    // of all sessions; by part
  std::vector<std::string> notes;  // what the numbers can't say, and what is missing in them
  SpacingSweep sweep;
};

inline constexpr double kConfidence = 0.95;

// Whether a comparison's decisive_p is so small that the difference is no chance, at kConfidence.
[[nodiscard]] bool IsSure(const Comparison& comparison);

// All that a spacing of the session's layout may be, in steps of 10 mm, or in 60 larger ones. An empty name:
// the layout's only one. Throws: core::Error{kRange} for a name that it hasn't, and where it has none or
// several to choose from; what SessionReader throws.
[[nodiscard]] SpacingRange FullRange(const std::filesystem::path& session, const std::string& name,
                                     const std::stop_token& stop);

// Sweeps all sessions (SweepSpacing), and puts together what their participants estimated and answered.
// `baseline`: a condition; what is compared of the others is then what each participant has more than in
// their own trials of it. Throws: as SweepSpacing; core::Error{kRange} where no session has that condition.
[[nodiscard]] Study MakeStudy(const SweepRequest& request, const core::Progress& progress,
                              const std::stop_token& stop, const std::string& baseline = {});

}  // namespace elbowroom::control
