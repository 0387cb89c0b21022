// The tables of a study: participants.csv, sessions.csv and comparisons.csv.
#pragma once

#include <filesystem>
#include <vector>

#include "app/control/study/study.h"

namespace elbowroom::control {

// In `folder`, which is made if it isn't there; all or none. Throws: core::Error{kFile}.
[[nodiscard]] std::vector<std::filesystem::path> WriteStudy(const Study& study,
                                                            const std::filesystem::path& folder);

}  // namespace elbowroom::control
