#include "recon/gl/paper_methods/plane_sweep_gl.h"

#include <gtest/gtest.h>

#include <iostream>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/paper_methods/sweep_comparison.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/recon/scenes/sweep_oracle.h"
#include "tests/support/soak.h"

namespace elbowroom::recon::gl {
namespace {

// The whole way in single precision, from the pixel on (docs/plane_sweep.md, "Rounding").
constexpr SweepBand kGlBand{64.0, kGlFilterCoverage};

std::vector<core::SoftMask> WithLevels(Random* random, const std::vector<core::BitMask>& masks) {
  std::vector<core::SoftMask> soft;
  for (const core::BitMask& mask : masks) {
    soft.push_back(random->Chance(0.5) ? WithRandomLevels(random, mask) : core::SoftMask{mask, {}});
  }
  return soft;
}

// Both pictures against the oracle: where they differ, the oracle is unsure.
void ExpectOracles(Random* random, const RandomScene& scene, const core::CameraModel& view,
                   SweepPasses passes, PlaneSweepGl* sweep, const PlaneSweepOptions& options, int* hits,
                   const SweepBand& band = kGlBand) {
  const auto masks = WithLevels(random, scene.masks);
  const SweptView swept = sweep->Sweep(*scene.rig, masks, view, SweepRays(view), options, passes);
  const SweepCheck check = CheckSweep(*scene.rig, masks, view, options, swept.picture, band);
  ASSERT_EQ(check.wrong_pixels, 0) << check.first_wrong;
  EXPECT_EQ(swept.picture.hit_pixels, check.hit_pixels);
  *hits += check.hit_pixels;
}

TEST(PlaneSweepGl, IsTheOraclesOnRandomRigs) {
  Random random(7201);
  PlaneSweepGl sweep;
  std::cout << sweep.driver() << '\n';
  int hits = 0;
  for (int i = 0; i < 36 * test_support::SoakScale(); ++i) {
    const RandomScene scene = MakeRandomScene(&random);
    const auto view = RandomView(&random, static_cast<LensKind>(i % kLensKinds), *scene.rig);
    PlaneSweepOptions options;
    options.spacing_mm = scene.rig->workspace_mm.diagonal().norm() / 40.0;
    const auto passes = i % 2 == 0 ? SweepPasses::kOneAPlane : SweepPasses::kOneAPlaneAndCamera;
    ExpectOracles(&random, scene, view, passes, &sweep, options, &hits);
    if (HasFatalFailure()) FAIL() << "scene " << i;
  }
  EXPECT_GT(hits, 10'000);
}

// The two ways and the CPU: the same picture but for a few pixels of the band.
TEST(PlaneSweepGl, BothWaysAgreeWithTheCpu) {
  constexpr double kMostInTheBand = 0.02;  // of the hit pixels
  Random random(7202);
  PlaneSweepGl sweep;
  std::int64_t hits = 0, differing = 0;
  for (int i = 0; i < 8; ++i) {
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, 3 + i % 3, unseen);
    const auto masks = WithLevels(&random, scene.masks);
    const auto view = RandomView(&random, static_cast<LensKind>(i % kLensKinds), *scene.rig);
    PlaneSweepOptions options;
    options.spacing_mm = 12.0;
    const SweptView cpu = SweepPlanes(*scene.rig, masks, view, options);
    for (const auto passes : {SweepPasses::kOneAPlane, SweepPasses::kOneAPlaneAndCamera}) {
      const SweptView gl = sweep.Sweep(*scene.rig, masks, view, SweepRays(view), options, passes);
      EXPECT_EQ(gl.stats.planes, cpu.stats.planes);
      for (std::size_t p = 0; p < cpu.picture.depth_mm.size(); ++p) {
        hits += cpu.picture.depth_mm[p] != 0.0F ? 1 : 0;
        differing += cpu.picture.depth_mm[p] != gl.picture.depth_mm[p] ? 1 : 0;
      }
    }
  }
  EXPECT_GT(hits, 5000);
  EXPECT_LT(static_cast<double>(differing), kMostInTheBand * static_cast<double>(hits));
}

// The grid's positions are interpolated by the graphics card, from corners that are the CPU's.
TEST(PlaneSweepGl, AGridIsWhatItsPositionsSay) {
  Random random(7205);
  PlaneSweepGl sweep;
  // Corners are drawn to 8 bits of a pixel by Mesa, to 4 at least by any driver.
  SweepBand band = kGlBand;
  band.corner_px = 1.0 / 256.0;
  int hits = 0;
  for (int i = 0; i < 12; ++i) {
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, 3 + i % 3, unseen);
    const auto view = RandomView(&random, static_cast<LensKind>(i % kLensKinds), *scene.rig);
    const PlaneSweepOptions options{.spacing_mm = 12.0, .undistortion_grid = 1 + i % 8};
    ExpectOracles(&random, scene, view, SweepPasses::kOneAPlaneAndCamera, &sweep, options, &hits, band);
    if (HasFatalFailure()) FAIL() << "scene " << i;
  }
  EXPECT_GT(hits, 5000);
}

// As the self-test compares them.
TEST(PlaneSweepGl, AGridIsTheCpusButForRounding) {
  constexpr double kMostInTheBand = 0.02;  // of the hit pixels
  Random random(7206);
  PlaneSweepGl sweep;
  std::int64_t hits = 0, differing = 0;
  for (int i = 0; i < 6; ++i) {
    const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
    const auto masks = WithLevels(&random, scene.masks);
    const auto view = RandomView(&random, LensKind::kPinhole, *scene.rig);
    const PlaneSweepOptions options{.spacing_mm = 12.0, .undistortion_grid = 5};
    const SweptView cpu = SweepPlanes(*scene.rig, masks, view, options);
    const SweptView gl =
        sweep.Sweep(*scene.rig, masks, view, SweepRays(view), options, SweepPasses::kOneAPlaneAndCamera);
    const SweepComparison comparison =
        CompareSweeps(*scene.rig, masks, view, cpu.picture, gl.picture, options.undistortion_grid);
    EXPECT_EQ(comparison.unexplained_pixels, 0) << "scene " << i;
    hits += cpu.picture.hit_pixels;
    differing += comparison.differing_pixels;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_LT(static_cast<double>(differing), kMostInTheBand * static_cast<double>(hits));
}

// The paper's formulas, but for the last draw of a plane, which takes one triangle here and two there.
TEST(PlaneSweepGl, CountsItsWorkAsThePaperDoes) {
  constexpr std::int64_t kCameras = 3, kCells = 5;
  Random random(7208);
  PlaneSweepGl sweep;
  const RandomScene scene = MakeRingScene(&random, kCameras, core::UnseenPolicy::kOutside);
  const auto masks = WithLevels(&random, scene.masks);
  const auto view = RandomView(&random, LensKind::kPinhole, *scene.rig);
  const SweptView paper = sweep.Sweep(*scene.rig, masks, view, SweepRays(view), {.undistortion_grid = kCells},
                                      SweepPasses::kOneAPlaneAndCamera);
  const std::int64_t pixels = std::int64_t{view.width_px()} * view.height_px();
  ASSERT_GT(paper.stats.planes, 5);
  EXPECT_EQ(paper.stats.drawn_triangles, (2 * kCameras * kCells * kCells + 1) * paper.stats.planes);
  EXPECT_EQ(paper.stats.filled_pixels, (kCameras + 1) * paper.stats.planes * pixels);
  const SweptView cut = sweep.Sweep(*scene.rig, masks, view, SweepRays(view));
  EXPECT_LE(cut.stats.drawn_triangles, paper.stats.planes);
  EXPECT_EQ(cut.stats.filled_pixels, cut.stats.tested_points);
}

TEST(PlaneSweepGl, AGridBelongsToThePapersPasses) {
  Random random(7207);
  PlaneSweepGl sweep;
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const auto view = RandomView(&random, LensKind::kPinhole, *scene.rig);
  EXPECT_THROW((void)sweep.Sweep(*scene.rig, WithLevels(&random, scene.masks), view, SweepRays(view),
                                 {.undistortion_grid = 5}, SweepPasses::kOneAPlane),
               core::PreconditionError);
}

// More cameras than OpenGL has textures at once are asked in groups.
TEST(PlaneSweepGl, TwentyCamerasAreAskedInGroups) {
  Random random(7203);
  PlaneSweepGl sweep;
  int hits = 0;
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    RandomScene scene = MakeRingScene(&random, 20, unseen);
    // Blobs for the first and the last few; all of the others' pictures is object.
    for (std::size_t i = 2; i < 18; ++i) {
      for (int p = 0; p < 160 * 120; ++p) scene.masks[i].Set(p % 160, p / 160, true);
    }
    const auto view = RandomView(&random, LensKind::kPinhole, *scene.rig);
    PlaneSweepOptions options;
    options.spacing_mm = 8.0;
    ExpectOracles(&random, scene, view, SweepPasses::kOneAPlane, &sweep, options, &hits);
  }
  EXPECT_GT(hits, 100);
}

TEST(PlaneSweepGl, OnlyTheCutWaySkips) {
  Random random(7204);
  PlaneSweepGl sweep;
  const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kOutside);
  const auto view = RandomView(&random, LensKind::kPinhole, *scene.rig);
  const auto masks = WithLevels(&random, scene.masks);
  const SweepRays rays(view);
  const SweptView cut = sweep.Sweep(*scene.rig, masks, view, rays);
  const SweptView whole = sweep.Sweep(*scene.rig, masks, view, rays, {}, SweepPasses::kOneAPlaneAndCamera);
  EXPECT_GT(cut.stats.skipped_points, 0);
  EXPECT_EQ(whole.stats.skipped_points, 0);
  EXPECT_EQ(cut.picture.depth_mm, whole.picture.depth_mm);
}

TEST(PlaneSweepGl, MovedFromIsNotUsed) {
  PlaneSweepGl first;
  const PlaneSweepGl second = std::move(first);
  EXPECT_FALSE(second.driver().empty());
  // NOLINTNEXTLINE(bugprone-use-after-move, clang-analyzer-cplusplus.Move)
  EXPECT_THROW((void)first.driver(), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon::gl
