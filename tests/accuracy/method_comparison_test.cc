// The table of methods, on a small view: every method has an error, and the exact ones hardly any.
#include "tests/accuracy/method_comparison.h"

#include <gtest/gtest.h>

#include <array>

namespace elbowroom::accuracy {
namespace {

const ComparedScene& SmallComparedScene() {
  static const ComparedScene scene = MakeComparedScene("three", recon::ViewSceneRig::kThree, 160, 120);
  return scene;
}

TEST(ViewMethods, SeeTheHullOfTheMasks) {
  constexpr double kLargestRmsMm = 10.0;   // of the coarsest setting in the table
  constexpr double kLargestMissing = 0.1;  // of the hull's pixels
  for (const ViewMethod& method : ViewMethods()) {
    SCOPED_TRACE(method.Name());
    ErrorTally tally;
    tally.Add(SmallComparedScene().mask_hull, method.view(SmallComparedScene().task));
    const DepthError error = tally.Summary();
    EXPECT_GT(error.compared, 500);
    EXPECT_LT(error.surface_rms_mm, kLargestRmsMm);
    EXPECT_LT(error.missing_share, kLargestMissing);
  }
}

TEST(ExactView, IsTheBruteForceHullOfTheMasks) {
  constexpr double kTypicalMm = 1e-3;  // float32 depths
  constexpr double kGrazing = 0.002;   // of the pixels: slivers shorter than the oracle's step
  ErrorTally tally;
  tally.Add(SmallComparedScene().mask_hull, ExactView(SmallComparedScene().task));
  const DepthError error = tally.Summary();
  EXPECT_LT(error.surface_p95_mm, kTypicalMm);
  EXPECT_LT(error.missing_share + error.extra_share, kGrazing);
}

TEST(TimeInTurns, RunsEveryJobAsOftenAsAsked) {
  std::array<int, 2> runs{};
  const std::vector<std::function<void()>> jobs = {[&] { ++runs[0]; }, [&] { ++runs[1]; }};
  const std::vector<Timing> timings =
      TimeInTurns(jobs, 1, {.repetitions = 5, .slow_repetitions = 2, .slow_ms = 1e9});
  EXPECT_EQ(runs, (std::array<int, 2>{6, 6}));
  EXPECT_EQ(timings[0].repetitions, 5);
  (void)TimeInTurns(jobs, 1, {.repetitions = 5, .slow_repetitions = 2, .slow_ms = -1.0});
  EXPECT_EQ(runs, (std::array<int, 2>{9, 9}));
}

}  // namespace
}  // namespace elbowroom::accuracy
