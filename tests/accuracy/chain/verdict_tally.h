// How often each verdict was given, by how far the part truly was from the real object.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact.h"

namespace elbowroom::accuracy {

// Truly this far apart, in mm: from `from_mm`, below `to_mm`. Below 0 they overlap.
struct DistanceRange {
  int from_mm = 0;
  int to_mm = 0;
};

// Counts by verdict and by distance in steps of 1 mm, from kDeepestMm to kFarthestMm; what is beyond either
// end counts in a step of its own.
class VerdictTally {
 public:
  static constexpr int kDeepestMm = -40, kFarthestMm = 100;

  void Add(double true_mm, core::Verdict verdict);
  VerdictTally& operator+=(const VerdictTally& other);

  [[nodiscard]] std::int64_t Count(core::Verdict verdict, const DistanceRange& range) const;
  [[nodiscard]] std::int64_t Count(const DistanceRange& range) const;

 private:
  static constexpr std::size_t kSteps = kFarthestMm - kDeepestMm + 2;
  [[nodiscard]] static std::size_t StepOf(int mm);

  std::array<std::array<std::int64_t, 4>, kSteps> counts_{};
};

inline constexpr DistanceRange kTouching{VerdictTally::kDeepestMm - 1, 0};
inline constexpr DistanceRange kApart{0, VerdictTally::kFarthestMm + 1};
inline constexpr DistanceRange kAnywhere{VerdictTally::kDeepestMm - 1, VerdictTally::kFarthestMm + 1};

}  // namespace elbowroom::accuracy
