// The files of a study: participants.csv, sessions.csv, comparisons.csv, report.html and report.pdf; with a
// baseline, baseline.csv.
#pragma once

#include <filesystem>
#include <stop_token>
#include <vector>

#include "app/control/study/study.h"
#include "core/progress.h"

namespace elbowroom::control {

// In `folder`, which is made if it isn't there; all or none. Throws: core::Error{kFile}; as MakeStudyReport.
[[nodiscard]] std::vector<std::filesystem::path> WriteStudy(const Study& study,
                                                            const std::filesystem::path& folder,
                                                            const core::Progress& progress,
                                                            const std::stop_token& stop);

}  // namespace elbowroom::control
