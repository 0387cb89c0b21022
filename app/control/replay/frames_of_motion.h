// Which frames before one tell how its silhouettes move.
#pragma once

#include <cstddef>
#include <span>

#include "sessions/session_reader.h"

namespace elbowroom::control {

// How many frames before that at position `first` are needed so that the motion of each camera's silhouette
// is known as it was in the trial. `rows`: the stamps of the session's frames; `frames`: all of them.
[[nodiscard]] std::size_t FramesOfMotion(std::span<const sessions::StampRow> rows,
                                         std::span<const sessions::FrameSummary> frames, std::size_t first);

}  // namespace elbowroom::control
