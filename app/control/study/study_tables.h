// The tables of a study's report.
#pragma once

#include "app/control/study/study.h"
#include "sessions/document/document.h"

namespace elbowroom::control {

// As the paper's Table 3, with the mean and the SD of each column below. Its cells' marks have the colours of
// EstimateChart's.
[[nodiscard]] sessions::DocumentTable ParticipantTable(const Study& study);

// A group of rows for each measure, a row for each two conditions; highlighted where decisive_p is small.
[[nodiscard]] sessions::DocumentTable ComparisonTable(const Study& study);

[[nodiscard]] sessions::DocumentTable CorrelationTable(const Study& study);

[[nodiscard]] sessions::DocumentTable SessionTable(const Study& study);

}  // namespace elbowroom::control
