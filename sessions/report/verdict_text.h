// A trial's outcome in words.
#pragma once

#include <string>

#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

// "5 touches in 62.0 s, all with 'PMT to A' at 140 mm; the task needed more than 140 mm and at most 240 mm,
// up to 100 mm more than the participant's estimate of 140 mm." Plain text, not escaped.
[[nodiscard]] std::string VerdictSentence(const ReportData& data);

// "5 on payload A, none on PMT box." Empty without parts.
[[nodiscard]] std::string TouchesByPart(const ReportData& data);

// "140–240 mm": touched at the first, free of touches at the second; "unknown" where nothing was tried.
[[nodiscard]] std::string SpaceNeeded(const ReportData& data);

// The same of some of the frames; unless these are the whole task's, nothing is known to be enough.
[[nodiscard]] std::string NeedText(const SpaceNeed& need, bool is_whole_task);

// "140–240 mm": the least and the largest value that the judged spacing had.
[[nodiscard]] std::string SpaceProvided(const ReportData& data);

// The space needed less the participant's estimate: "20–60 mm", "at most 56 mm", "more than 20 mm", "none"
// where the estimate is enough, "unknown".
[[nodiscard]] std::string Shortfall(const ReportData& data);

// Of a gauge that failed: what was measured, and what follows. Empty otherwise.
[[nodiscard]] std::string GaugeFailure(const core::RigQuality& quality);

// One decimal, none where it is zero: "140 mm", "12.5 mm".
[[nodiscard]] std::string Millimetres(double length_mm);

}  // namespace elbowroom::sessions
