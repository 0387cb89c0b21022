// Conditions of a study held against each other.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/control/study/study_sessions.h"
#include "core/statistics/correlation.h"
#include "core/statistics/mean_comparison.h"
#include "core/statistics/rank_sum.h"

namespace elbowroom::control {

// Of each participant, the mean of the sessions.
using ByParticipant = std::map<std::string, double>;
using ByCondition = std::map<std::string, ByParticipant>;

// By measure. Sessions without a condition are left out.
[[nodiscard]] std::map<std::string, ByCondition> MeansByCondition(const std::vector<StudySession>& sessions);

// What a participant's measure is more than in their own trials of the baseline condition.
struct BeyondBaseline {
  std::string participant;
  std::string condition;  // another one than the baseline
  std::string measure;
  double value = 0.0;     // the mean of the participant's sessions in the condition
  double baseline = 0.0;  // likewise in the baseline condition
  [[nodiscard]] double difference() const { return value - baseline; }
};

// Of every measure; by measure, condition and participant. A participant without the measure in one of both
// has no row.
[[nodiscard]] std::vector<BeyondBaseline> BeyondTheBaseline(
    const std::map<std::string, ByCondition>& measures, const std::string& baseline);

// The differences, as MeansByCondition has values.
[[nodiscard]] std::map<std::string, ByCondition> DifferencesByCondition(
    const std::vector<BeyondBaseline>& beyond);

// A measure in two conditions. Each participant counts once a condition, with the mean of the sessions.
struct Comparison {
  std::string measure;
  std::string a, b;  // conditions
  core::Summary of_a, of_b;
  std::optional<core::MeanComparison> means = {};  // Welch's t-test
  std::optional<double> corrected_p = {};          // of `means`, for all comparisons of the study (Holm)
  std::optional<double> effect_size = {};          // Hedges' g
  std::optional<core::RankSumTest> ranks = {};     // Mann and Whitney's test
  std::size_t in_both = 0;                         // participants who did both conditions
  // Of those, where there are no others: the t-test of pairs, which is then the sharper one.
  std::optional<core::MeanComparison> pairs = {};
  // Of the test that decides, `pairs` where there is one and else `means`; for all comparisons of the study
  // (Holm).
  std::optional<double> decisive_p = {};
};

// Every measure that both of two conditions have, for every two conditions; by measure, then by condition.
[[nodiscard]] std::vector<Comparison> CompareConditions(const std::map<std::string, ByCondition>& measures);

// The comparison with the smallest decisive_p; null: none has one.
[[nodiscard]] const Comparison* SurestOf(const std::vector<Comparison>& comparisons);

struct MeasuresCorrelated {
  std::string a, b;  // measures
  core::Correlation correlation;
};

// Of each measure with needed_mm, each participant once with the mean of the sessions; by name.
[[nodiscard]] std::vector<MeasuresCorrelated> CorrelateWithNeed(const std::vector<StudySession>& sessions);

}  // namespace elbowroom::control
