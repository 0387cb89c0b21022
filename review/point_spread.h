// A few contact points that represent many.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/contact.h"
#include "review/review_scratch.h"

namespace elbowroom::review {

// At most `count` of the points, chosen by farthest-point sampling from the first. Each keeps its depth and
// takes over the area of the dropped points that are nearest to it, so that the total area stays. If there
// are no more than `count` points, they are returned unchanged.
[[nodiscard]] std::vector<core::ContactPoint> SpreadEvenly(std::span<const core::ContactPoint> points,
                                                           std::size_t count);
// The same, in the memory of `scratch->kept`.
[[nodiscard]] std::vector<core::ContactPoint> SpreadEvenly(std::span<const core::ContactPoint> points,
                                                           std::size_t count, SpreadScratch* scratch);

}  // namespace elbowroom::review
