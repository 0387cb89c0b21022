// The paper's work figures, on a small view.
#include "tests/accuracy/sweep_work.h"

#include <gtest/gtest.h>

namespace elbowroom::accuracy {
namespace {

constexpr int kWidthPx = 160, kHeightPx = 120;
constexpr std::int64_t kPlanes = 50, kCameras = 3, kCells = 5;

const SweepWorkResult& Result() {
  static const SweepWorkResult result =
      TimeSweepWork({.repetitions = 1, .slow_repetitions = 1, .slow_ms = 1e9}, kWidthPx);
  return result;
}

TEST(TimeSweepWork, CountsThePapersWork) {
  const SweepWork& paper = Result().methods.front();
  EXPECT_EQ(paper.planes, kPlanes);
  EXPECT_EQ(paper.triangles, (2 * kCameras * kCells * kCells + 1) * kPlanes);
  EXPECT_EQ(paper.filled_pixels, (kCameras + 1) * kPlanes * kWidthPx * kHeightPx);
  EXPECT_EQ(Result().segmented.pixels, kCameras * 720 * 243);
}

TEST(TimeSweepWork, EveryWaySeesTheHull) {
  constexpr double kSpacingMm = 15.0;
  constexpr double kExactMm = 0.1;  // but for slivers thinner than the oracle's step
  for (const SweepWork& method : Result().methods) {
    SCOPED_TRACE(method.method);
    EXPECT_GT(method.to_mask_hull.compared, 500);
    EXPECT_LT(method.to_mask_hull.surface_rms_mm, method.planes > 0 ? kSpacingMm : kExactMm);
    EXPECT_GT(method.to_analytic_hull.surface_rms_mm, 0.0);
  }
  const SweepWork &paper = Result().methods.front(), &best = Result().methods[2];
  EXPECT_LT(best.filled_pixels, paper.filled_pixels);
}

// The paper's rig has no lens, so a grid changes nothing.
TEST(TimeSweepWork, TheGridIsNoWorseWithoutALens) {
  const DepthError &grid = Result().methods[0].to_mask_hull, &none = Result().methods[1].to_mask_hull;
  EXPECT_NEAR(grid.surface_rms_mm, none.surface_rms_mm, 0.05 * none.surface_rms_mm);
}

}  // namespace
}  // namespace elbowroom::accuracy
