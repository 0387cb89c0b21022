// How much space the recorded motion needs: one spacing of a session's layout swept over a range.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/session.h"
#include "review/spacing_study.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

struct SpacingRange {
  std::string spacing;  // its name
  double from_mm = 0.0;
  double to_mm = 0.0;
  double step_mm = 10.0;
};

// Judges every recorded frame of the session at every step, against the clearance that the trial required.
// Throws: core::Error{kRange}: no such spacing, a range beyond its limits, a session without frames; what
// SessionReader throws; Error{kCancelled}.
[[nodiscard]] review::SpacingStudy SweepSpacing(const sessions::SessionReader& session,
                                                const SpacingRange& range, const core::Progress& progress,
                                                std::stop_token stop);

// sweep.csv (a line for each part at each step), sweep.svg and sweep.png in `folder`, which is made if it
// isn't there; all or none. Throws: core::Error{kFile}.
[[nodiscard]] std::vector<std::filesystem::path> WriteSpacingSweep(const core::SessionHeader& header,
                                                                   const SpacingRange& range,
                                                                   const review::SpacingStudy& study,
                                                                   const std::filesystem::path& folder);

}  // namespace elbowroom::control
