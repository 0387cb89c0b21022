#include "recon/segmentation/coverage_steps.h"

#include <cmath>
#include <cstdlib>

namespace elbowroom::recon {
namespace {

PackedSteps StepsAlong(int x, int y) {
  if (x == 0 && y == 0) return kIsAlongX;
  const double length = std::hypot(x, y);
  PackedSteps packed = kHasDirection | (std::abs(x) >= std::abs(y) ? kIsAlongX : 0U);
  unsigned shift = 0;
  for (const double steps : {1.0, 2.0, 3.0}) {
    for (const int along : {x, y}) {
      const auto rounded = static_cast<PackedSteps>(std::lround(steps * along / length));
      packed |= (rounded & ((1U << kStepBits) - 1)) << shift;
      shift += kStepBits;
    }
  }
  return packed;
}

}  // namespace

const StepTable& AllSteps() {
  static const StepTable steps = [] {
    StepTable made;
    auto* next = made.data();
    for (int y = -kMostMoment; y <= kMostMoment; ++y)
      for (int x = -kMostMoment; x <= kMostMoment; ++x) *next++ = StepsAlong(x, y);
    return made;
  }();
  return steps;
}

}  // namespace elbowroom::recon
