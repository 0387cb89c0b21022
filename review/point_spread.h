// A few points that stand for many.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/contact.h"

namespace elbowroom::review {

// At most `count` of the points, spread by farthest-point sampling from the first; each keeps its depth and
// takes over the area of the dropped points nearest to it, so that the total area stays. Fewer points than
// that come back as they are.
[[nodiscard]] std::vector<core::ContactPoint> SpreadEvenly(std::span<const core::ContactPoint> points,
                                                           std::size_t count);

}  // namespace elbowroom::review
