// A pair of virtual parts over the time of a trial.
#pragma once

#include <optional>
#include <vector>

#include "sessions/charts/chart.h"
#include "sessions/report/pair_approaches.h"
#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

struct PairCourse {
  std::size_t pair = 0;  // in PairApproaches::pairs
  // The setting of the spacings at which the two were closest, and when they were set so first.
  const PairSetting* closest = nullptr;
  double time_s = 0.0;
  double broken_s = 0.0;  // how long the rule wasn't kept, or that wasn't certain
  // The closest of each column of ReportData::columns; nothing: no setting in it was judged.
  std::vector<std::optional<PairDistance>> columns;

  [[nodiscard]] const PairDistance& closest_distance() const { return closest->distances[pair]; }
};

// One a pair, in their order; none of a pair that no frame judged. They point into `approaches`.
[[nodiscard]] std::vector<PairCourse> CoursesOf(const ReportData& data, const PairApproaches& approaches);

// The pairs that came closest to breaking their rules, most of them as panels; the others are in the table.
inline constexpr std::size_t kMostPairPanels = 8;

// For each of these pairs the gap between the surfaces, dashed where only a lower bound was needed, with what
// the rule requires.
[[nodiscard]] Chart PairChart(const ReportData& data, const PairApproaches& approaches,
                              const std::vector<PairCourse>& courses);

}  // namespace elbowroom::sessions
