// The stamp of every camera in every frame as a line of comma-separated values.
#pragma once

#include <span>
#include <string>

#include "core/rig.h"
#include "sessions/stamp_rows.h"

namespace elbowroom::sessions {

// A header line, then a line for each camera in each frame (RFC 4180, but lines end in \n). skew_ms: from the
// frame's time to the middle of the picture's exposure. A missing picture has empty fields.
[[nodiscard]] std::string StampsCsv(const core::Rig& rig, std::span<const StampRow> frames);

}  // namespace elbowroom::sessions
