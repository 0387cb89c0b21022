// The median of a tally against that of the times themselves.
#include "app/control/frame_time_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace elbowroom::control {
namespace {

constexpr double kHalfAStep = 0.006;  // the docstring's 0.5 %, and rounding up to the step's end

TEST(FrameTimeTally, MedianIsWithinHalfAStep) {
  std::mt19937 random(5);
  std::lognormal_distribution<double> time_ms(1.0, 2.0);
  for (const int count : {1, 2, 7, 1000}) {
    FrameTimeTally tally;
    std::vector<double> times_ms;
    for (int i = 0; i < count; ++i) {
      times_ms.push_back(time_ms(random));
      tally.Add(times_ms.back());
    }
    const auto middle = times_ms.begin() + count / 2;
    std::nth_element(times_ms.begin(), middle, times_ms.end());
    ASSERT_TRUE(tally.MedianMs());
    EXPECT_NEAR(*tally.MedianMs() / *middle, 1.0, kHalfAStep);
  }
}

TEST(FrameTimeTally, HasNoMedianWithoutFrames) { EXPECT_FALSE(FrameTimeTally().MedianMs()); }

TEST(FrameTimeTally, TakesTimesBeyondItsSteps) {
  FrameTimeTally tally;
  tally.Add(0.0);
  EXPECT_GT(*tally.MedianMs(), 0.0);
  tally.Add(1e12);
  EXPECT_GT(*tally.MedianMs(), 9e5);
}

}  // namespace
}  // namespace elbowroom::control
