// Virtual parts held against each other at the spacings that a trial had.
#pragma once

#include <cstddef>
#include <span>
#include <stop_token>

#include "core/layout.h"
#include "sessions/report/pair_approaches.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// A slider passes many settings of the spacings: so many are judged, those held longest, and the least and
// the largest value of each spacing.
inline constexpr std::size_t kMostSettings = 64;

// The pairs of the layout's rules, judged as by `elbowroom clash` at each setting of the frames, where the
// parts stand before any of them gives way. Throws: core::Error{kCancelled}; core::Error{kRange} as
// review::PairsOf.
[[nodiscard]] sessions::PairApproaches PairApproachesOf(const core::Layout& layout,
                                                        std::span<const sessions::FrameSummary> frames,
                                                        const std::stop_token& stop);

}  // namespace elbowroom::control
