// What clearance costs, by the shape of the part and the number of its triangles.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/accuracy/interleaved_timing.h"

namespace elbowroom::accuracy {

// A part beside or around the demo's hand, three cameras; tolerance 1 mm, one thread, hull in memory, no
// hint.
struct ShapeCost {
  std::string shape;
  std::size_t triangles = 0;
  Timing clearance;
  double error_mm = 0.0;     // upper bound - the clearance to a hundredth of a millimetre
  double promised_mm = 0.0;  // upper - lower
  bool is_certified = true;  // the bounds hold that clearance
  std::int64_t queries = 0;  // of the hull
  std::int64_t distances = 0;
};

// Flat (a panel 30 mm below), convex (a sphere 52 mm below and one 52 mm beside), concave (a bore around the
// arm), equidistant (a shell around the hand), a forest of needles 30 mm below; each with every number of
// triangles, one after the other.
[[nodiscard]] std::vector<ShapeCost> MeasureShapeCosts(std::span<const int> triangles,
                                                       const TimingEffort& effort = {});

}  // namespace elbowroom::accuracy
