// What the report of a sweep against revisions says.
#pragma once

#include "app/control/sweep/spacing_sweep.h"
#include "sessions/document/document.h"
#include "sessions/report/drawn_chart.h"

namespace elbowroom::control {

// The same sweep gives the same document. Throws: as sessions::Drawn; PreconditionError without revisions.
[[nodiscard]] sessions::Document RevisionDocument(const SpacingRange& range, const SpacingSweep& sweep,
                                                  sessions::ChartPainters* painters);

}  // namespace elbowroom::control
