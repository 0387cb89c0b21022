#include "tests/accuracy/chain/verdict_tally.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace elbowroom::accuracy {

// Steps begin at kDeepestMm - 1, which holds all that is deeper, and end with the one from kFarthestMm on.
std::size_t VerdictTally::StepOf(int mm) {
  return static_cast<std::size_t>(std::clamp(mm, kDeepestMm - 1, kFarthestMm) - (kDeepestMm - 1));
}

void VerdictTally::Add(double true_mm, core::Verdict verdict) {
  const double mm = std::clamp(std::floor(true_mm), double{kDeepestMm - 1}, double{kFarthestMm});
  ++counts_[StepOf(static_cast<int>(mm))][static_cast<std::size_t>(verdict)];
}

VerdictTally& VerdictTally::operator+=(const VerdictTally& other) {
  for (std::size_t step = 0; step < kSteps; ++step)
    for (std::size_t verdict = 0; verdict < counts_[step].size(); ++verdict)
      counts_[step][verdict] += other.counts_[step][verdict];
  return *this;
}

std::int64_t VerdictTally::Count(core::Verdict verdict, const DistanceRange& range) const {
  std::int64_t count = 0;
  for (int mm = range.from_mm; mm < range.to_mm; ++mm)
    count += counts_[StepOf(mm)][static_cast<std::size_t>(verdict)];
  return count;
}

std::int64_t VerdictTally::Count(const DistanceRange& range) const {
  std::int64_t count = 0;
  for (const core::Verdict verdict :
       {core::Verdict::kContact, core::Verdict::kNear, core::Verdict::kClear, core::Verdict::kUndecided})
    count += Count(verdict, range);
  return count;
}

}  // namespace elbowroom::accuracy
