#include "recon/paper_methods/plane_sweep.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "recon/paper_methods/sweep_comparison.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/recon/scenes/sweep_oracle.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

std::vector<core::SoftMask> SoftMasks(Random* random, const std::vector<core::BitMask>& masks) {
  std::vector<core::SoftMask> soft;
  for (const core::BitMask& mask : masks) {
    soft.push_back(random->Chance(0.5) ? WithRandomLevels(random, mask) : core::SoftMask{mask, {}});
  }
  return soft;
}

std::vector<core::SoftMask> Ready(const std::vector<core::BitMask>& masks) {
  std::vector<core::SoftMask> soft;
  for (const core::BitMask& mask : masks) soft.push_back({mask, {}});
  return soft;
}

core::CameraModel PinholeView(const Vector3d& eye_in_world, const Vector3d& target_in_world) {
  core::CameraCalibration c;
  c.name = "view";
  c.image_width_px = 100;
  c.image_height_px = 75;
  c.camera_matrix << 140.0, 0.0, 49.5, 0.0, 140.0, 37.0, 0.0, 0.0, 1.0;
  c.cam_from_world = core::CamFromWorldLookingAt(eye_in_world, target_in_world);
  return core::CameraModel(std::move(c));
}

// About as many planes as the paper's.
double SpacingFor(const core::Rig& rig) { return rig.workspace_mm.diagonal().norm() / 40.0; }

TEST(PlaneSweep, IsTheOraclesOnRandomRigs) {
  Random random(7101);
  int hits = 0;
  for (int i = 0; i < 120 * test_support::SoakScale(); ++i) {
    const RandomScene scene = MakeRandomScene(&random);
    const auto masks = SoftMasks(&random, scene.masks);
    const auto view = RandomView(&random, static_cast<LensKind>(i % kLensKinds), *scene.rig);
    PlaneSweepOptions options;
    options.spacing_mm = SpacingFor(*scene.rig);
    const SweptView swept = SweepPlanes(*scene.rig, masks, view, options);
    const SweepCheck check = CheckSweep(*scene.rig, masks, view, options, swept.picture, {});
    ASSERT_EQ(check.wrong_pixels, 0) << "scene " << i << ": " << check.first_wrong;
    EXPECT_EQ(swept.picture.hit_pixels, check.hit_pixels);
    hits += check.hit_pixels;
  }
  EXPECT_GT(hits, 50'000);
}

TEST(PlaneSweep, IsTheOraclesOnOrdinaryRigs) {
  // Blobs of ordinary cameras: hardly any pixel is left to rounding.
  constexpr double kMostUnsure = 0.01;
  Random random(7102);
  int hits = 0, unsure = 0;
  for (int i = 0; i < 24; ++i) {
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, 2 + i % 5, unseen);
    const auto masks = SoftMasks(&random, scene.masks);
    const auto view = i % 3 == 0 ? PinholeView({500.0, 300.0, 300.0}, Vector3d::Zero())
                                 : RandomView(&random, LensKind::kFoldingBarrel, *scene.rig);
    PlaneSweepOptions options;
    options.spacing_mm = 9.0;
    const SweptView swept = SweepPlanes(*scene.rig, masks, view, options);
    const SweepCheck check = CheckSweep(*scene.rig, masks, view, options, swept.picture, {});
    ASSERT_EQ(check.wrong_pixels, 0) << "scene " << i << ": " << check.first_wrong;
    hits += check.hit_pixels;
    unsure += check.unsure_pixels;
  }
  EXPECT_GT(hits, 10'000);
  EXPECT_LT(unsure, kMostUnsure * hits);
}

// A ball seen by three to six pinholes and the view's first planes in it.
struct BallScene {
  core::Rig rig;
  std::vector<core::BitMask> masks;
};

constexpr double kBallRadiusMm = 60.0;

BallScene MakeBallScene(core::UnseenPolicy unseen) {
  BallScene scene;
  scene.rig.name = "ball";
  scene.rig.unseen = unseen;
  scene.rig.workspace_mm = {Vector3d::Constant(-150.0), Vector3d::Constant(150.0)};
  for (const Vector3d& direction :
       {Vector3d(1, 0, 0.3), Vector3d(0, 1, 0.2), Vector3d(-0.7, -0.7, 0.3), Vector3d(0.1, 0.2, 1.0)}) {
    core::CameraCalibration c;
    c.name = "cam" + std::to_string(scene.rig.cameras.size() + 1);
    c.image_width_px = 160;
    c.image_height_px = 120;
    c.camera_matrix << 400.0, 0.0, 79.5, 0.0, 400.0, 59.5, 0.0, 0.0, 1.0;
    c.cam_from_world = core::CamFromWorldLookingAt(900.0 * direction.normalized(), Vector3d::Zero());
    scene.rig.cameras.emplace_back(c);
    const core::CameraModel& camera = scene.rig.cameras.back();
    core::BitMask mask(160, 120);
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        const Vector3d ray = camera.NormalisedFromPixel({x, y})->homogeneous().normalized();
        const Vector3d center_in_cam = camera.cam_from_world().translation_mm;
        mask.Set(x, y, (center_in_cam - ray.dot(center_in_cam) * ray).norm() <= kBallRadiusMm);
      }
    }
    scene.masks.push_back(std::move(mask));
  }
  return scene;
}

TEST(PlaneSweep, FirstSurfaceIsWithinOneSpacingBehindTheHulls) {
  constexpr double kSpacingMm = 15.0;
  // A pixel's footprint is 2.3 mm, the surface up to twice as steep where it is compared; and the exact
  // view's silhouettes are squares, whose corners are half a pixel off.
  constexpr double kFootprintMm = 4.5;
  constexpr int kRimPx = 4;  // nearer to the rim the hull may be thinner than the spacing
  const BallScene scene = MakeBallScene(core::UnseenPolicy::kOutside);
  const auto view = PinholeView({450.0, 250.0, 300.0}, Vector3d::Zero());
  const SweptView swept = SweepPlanes(scene.rig, Ready(scene.masks), view, {.spacing_mm = kSpacingMm});
  const HullView exact = ViewHull(MakeVisualHull(std::make_shared<core::Rig>(scene.rig), scene.masks), view);
  const auto at = [&](std::span<const float> depth_mm, int x, int y) {
    return depth_mm[static_cast<std::size_t>(y * view.width_px() + x)];
  };
  int compared = 0;
  for (int y = kRimPx; y < view.height_px() - kRimPx; ++y) {
    for (int x = kRimPx; x < view.width_px() - kRimPx; ++x) {
      bool is_in_middle = true;
      for (int i = -kRimPx; i <= kRimPx; ++i) {
        for (int j = -kRimPx; j <= kRimPx; ++j) is_in_middle &= at(exact.depth_mm, x + i, y + j) > 0.0F;
      }
      if (!is_in_middle) continue;
      const double behind_mm = at(swept.picture.depth_mm, x, y) - at(exact.depth_mm, x, y);
      EXPECT_GT(behind_mm, -kFootprintMm) << x << ", " << y;
      EXPECT_LT(behind_mm, kSpacingMm + kFootprintMm) << x << ", " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

// Planes of a fine sweep hold all planes of a coarse one: its first surface can't be farther.
TEST(PlaneSweep, FinerPlanesOnlyComeNearer) {
  Random random(7103);
  constexpr double kSpacingMm = 16.0;
  int nearer = 0;
  for (int i = 0; i < 6; ++i) {
    const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kOutside);
    const auto view = RandomView(&random, LensKind::kPinhole, *scene.rig);
    const auto masks = Ready(scene.masks);
    const SweptView coarse = SweepPlanes(*scene.rig, masks, view, {.spacing_mm = kSpacingMm});
    const SweptView fine = SweepPlanes(*scene.rig, masks, view, {.spacing_mm = kSpacingMm / 8.0});
    for (std::size_t p = 0; p < coarse.picture.depth_mm.size(); ++p) {
      const float far_mm = coarse.picture.depth_mm[p], near_mm = fine.picture.depth_mm[p];
      if (far_mm == 0.0F) continue;
      ASSERT_TRUE(near_mm > 0.0F && near_mm <= far_mm);
      nearer += near_mm < far_mm ? 1 : 0;
    }
  }
  EXPECT_GT(nearer, 100);
}

TEST(PlaneSweep, EmptyAndFullMasks) {
  BallScene scene = MakeBallScene(core::UnseenPolicy::kOutside);
  const auto view = PinholeView({450.0, 250.0, 300.0}, Vector3d::Zero());
  const std::int64_t ball = SweepPlanes(scene.rig, Ready(scene.masks), view).picture.hit_pixels;
  EXPECT_GT(ball, 500);
  core::BitMask full = scene.masks[1];
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) full.Set(x, y, true);
  }
  std::vector<core::BitMask> masks = scene.masks;
  masks[1] = full;
  EXPECT_GT(SweepPlanes(scene.rig, Ready(masks), view).picture.hit_pixels, ball);
  masks[1] = core::BitMask(160, 120);
  const SweptView nothing = SweepPlanes(scene.rig, Ready(masks), view);
  EXPECT_EQ(nothing.picture.hit_pixels, 0);
  EXPECT_EQ(nothing.stats.tested_points, 0);  // the empty camera is asked first, and settles it
}

TEST(PlaneSweep, ACameraThatSeesNothingOfTheHullHasNoSayIfItAbstains) {
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    BallScene scene = MakeBallScene(unseen);
    const auto view = PinholeView({450.0, 250.0, 300.0}, Vector3d::Zero());
    const SweptView before = SweepPlanes(scene.rig, Ready(scene.masks), view);
    core::CameraCalibration away = scene.rig.cameras[0].calibration();
    away.name = "away";
    away.cam_from_world = core::CamFromWorldLookingAt({900.0, 0.0, 0.0}, {1800.0, 0.0, 0.0});
    scene.rig.cameras.emplace_back(away);
    scene.masks.emplace_back(160, 120);
    const SweptView after = SweepPlanes(scene.rig, Ready(scene.masks), view);
    if (unseen == core::UnseenPolicy::kOutside) {
      EXPECT_EQ(after.picture.hit_pixels, 0);
    } else {
      EXPECT_EQ(after.picture.depth_mm, before.picture.depth_mm);
    }
  }
}

TEST(PlaneSweep, WhatTheViewDoesNotShowCostsNothing) {
  const BallScene scene = MakeBallScene(core::UnseenPolicy::kOutside);
  const auto away = PinholeView({450.0, 250.0, 300.0}, {900.0, 500.0, 600.0});
  const SweptView swept = SweepPlanes(scene.rig, Ready(scene.masks), away);
  EXPECT_EQ(swept.picture.hit_pixels, 0);
  EXPECT_EQ(swept.stats.tested_points, 0);
  const auto towards = PinholeView({450.0, 250.0, 300.0}, Vector3d::Zero());
  const SweptView seen = SweepPlanes(scene.rig, Ready(scene.masks), towards);
  EXPECT_LT(seen.stats.tested_points, seen.stats.skipped_points / 4);
  EXPECT_EQ(seen.stats.tested_points + seen.stats.skipped_points, seen.stats.planes * 100 * 75);
}

TEST(PlaneSweep, PlanesKeepToTheirRange) {
  const BallScene scene = MakeBallScene(core::UnseenPolicy::kOutside);
  const auto view = PinholeView({450.0, 250.0, 300.0}, Vector3d::Zero());
  const SweptView all = SweepPlanes(scene.rig, Ready(scene.masks), view, {.spacing_mm = 10.0});
  const SweptView part = SweepPlanes(scene.rig, Ready(scene.masks), view,
                                     {.spacing_mm = 10.0, .near_mm = 560.0, .far_mm = 590.0});
  EXPECT_EQ(part.stats.planes, 4);
  EXPECT_LT(part.stats.planes, all.stats.planes);
  for (const float depth_mm : part.picture.depth_mm) {
    EXPECT_TRUE(depth_mm == 0.0F || (depth_mm >= 560.0F && depth_mm <= 590.0F)) << depth_mm;
  }
}

TEST(PlaneSweep, ARigCameraSeesItsOwnSilhouette) {
  const BallScene scene = MakeBallScene(core::UnseenPolicy::kOutside);
  const core::CameraModel& camera = scene.rig.cameras[2];
  const SweptView swept = SweepPlanes(scene.rig, Ready(scene.masks), camera, {.spacing_mm = 2.0});
  int seen = 0, missed = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      const bool is_hit = swept.picture.depth_mm[static_cast<std::size_t>(y * 160 + x)] != 0.0F;
      const bool is_object = scene.masks[2].At(x, y);
      EXPECT_LE(is_hit, is_object) << x << ", " << y;
      seen += is_object ? 1 : 0;
      missed += is_object && !is_hit ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 1000);
  // At the rim the ball is thinner than the spacing.
  EXPECT_LT(missed, seen / 20);
}

TEST(PlaneSweep, OneThreadGivesTheSamePicture) {
  Random random(7104);
  for (int i = 0; i < 4; ++i) {
    const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kAbstain);
    const auto view = RandomView(&random, LensKind::kTangential, *scene.rig);
    const SweptView many = SweepPlanes(*scene.rig, Ready(scene.masks), view);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const SweptView one = SweepPlanes(*scene.rig, Ready(scene.masks), view);
    EXPECT_EQ(one.picture.depth_mm, many.picture.depth_mm);
    EXPECT_EQ(one.stats.tested_points, many.stats.tested_points);
  }
}

TEST(PlaneSweep, ThePlainSweepAsksMoreAndSeesTheSame) {
  Random random(7106);
  std::int64_t plain_points = 0, points = 0, hits = 0;
  for (int i = 0; i < 8; ++i) {
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, 4, unseen);
    const auto view = RandomView(&random, LensKind::kPinhole, *scene.rig);
    const auto masks = SoftMasks(&random, scene.masks);
    PlaneSweepOptions options;
    options.spacing_mm = SpacingFor(*scene.rig);
    const SweptView swept = SweepPlanes(*scene.rig, masks, view, options);
    options.settles_regions = false;
    const SweptView plain = SweepPlanes(*scene.rig, masks, view, options);
    EXPECT_EQ(plain.picture.depth_mm, swept.picture.depth_mm) << "scene " << i;
    plain_points += plain.stats.tested_points, points += swept.stats.tested_points;
    hits += swept.picture.hit_pixels;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(plain_points, 3 * points);
}

// The finer the grid, the closer its picture to the one through the lens.
TEST(PlaneSweep, AFinerUndistortionGridIsCloserToTheLens) {
  Random random(7105);
  constexpr int kGrids[] = {2, 5, 33};
  // Pixels at the silhouettes' rims.
  constexpr double kLeftByTheFinest = 0.02;
  int differing[3] = {0, 0, 0}, hits = 0;
  for (int i = 0; i < 6; ++i) {
    const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
    const auto view = RandomView(&random, LensKind::kPinhole, *scene.rig);
    const auto masks = SoftMasks(&random, scene.masks);
    const SweptView lens = SweepPlanes(*scene.rig, masks, view);
    hits += static_cast<int>(lens.picture.hit_pixels);
    for (std::size_t g = 0; g < 3; ++g) {
      const SweptView grid = SweepPlanes(*scene.rig, masks, view, {.undistortion_grid = kGrids[g]});
      for (std::size_t p = 0; p < grid.picture.depth_mm.size(); ++p) {
        differing[g] += (grid.picture.depth_mm[p] != 0.0F) != (lens.picture.depth_mm[p] != 0.0F) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(differing[0], 2 * differing[1]);
  EXPECT_GT(differing[1], differing[2]);
  EXPECT_LT(differing[2], kLeftByTheFinest * hits);
}

// A grid corrects lenses and nothing else: without a lens it changes nothing.
TEST(PlaneSweep, AGridOfCamerasWithoutLensChangesNothing) {
  const BallScene scene = MakeBallScene(core::UnseenPolicy::kOutside);
  const auto view = PinholeView({450.0, 250.0, 300.0}, Vector3d::Zero());
  const auto masks = Ready(scene.masks);
  const DepthMap lens = SweepPlanes(scene.rig, masks, view).picture;
  for (const int cells : {1, 5}) {
    const DepthMap grid = SweepPlanes(scene.rig, masks, view, {.undistortion_grid = cells}).picture;
    const SweepComparison comparison = CompareSweeps(scene.rig, masks, view, lens, grid);
    EXPECT_EQ(comparison.unexplained_pixels, 0) << cells;
    EXPECT_LT(comparison.differing_pixels, lens.hit_pixels / 100) << cells;
  }
  EXPECT_GT(lens.hit_pixels, 500);
}

// A sweep through a grid is, plane by plane and pixel by pixel, what the cameras' coverage at the grid's
// positions says.
TEST(PlaneSweep, AGridIsWhatItsPositionsSay) {
  // Positions are linear over a triangle: hardly any pixel is left to rounding.
  constexpr double kMostUnsure = 0.02;
  Random random(7106);
  std::int64_t hits = 0, unsure = 0;
  for (int i = 0; i < 12 * test_support::SoakScale(); ++i) {
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, 3, unseen);
    const auto view = RandomView(&random, static_cast<LensKind>(i % kLensKinds), *scene.rig);
    const auto masks = SoftMasks(&random, scene.masks);
    const PlaneSweepOptions options{.spacing_mm = 15.0, .undistortion_grid = i % 3 == 0 ? 5 : 1 + i % 8};
    const SweptView swept = SweepPlanes(*scene.rig, masks, view, options);
    EXPECT_EQ(swept.stats.skipped_points + swept.stats.tested_points,
              swept.stats.planes * view.width_px() * view.height_px());
    const SweepCheck check = CheckSweep(*scene.rig, masks, view, options, swept.picture, {});
    ASSERT_EQ(check.wrong_pixels, 0) << "scene " << i << ": " << check.first_wrong;
    hits += check.hit_pixels;
    unsure += check.unsure_pixels;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_LT(static_cast<double>(unsure), kMostUnsure * static_cast<double>(hits));
}

TEST(SweepComparison, ExplainsRoundingAndNothingElse) {
  const BallScene scene = MakeBallScene(core::UnseenPolicy::kOutside);
  const auto view = PinholeView({450.0, 250.0, 300.0}, Vector3d::Zero());
  const auto masks = Ready(scene.masks);
  const DepthMap right = SweepPlanes(scene.rig, masks, view).picture;
  DepthMap wrong = right;
  EXPECT_EQ(CompareSweeps(scene.rig, masks, view, right, wrong).differing_pixels, 0);
  const std::size_t middle = 37 * 100 + 50, corner = 0;
  wrong.depth_mm[middle] += 15.0F;  // misses a plane well inside the ball
  wrong.depth_mm[corner] = 600.0F;  // sees one where all cameras see background
  const SweepComparison comparison = CompareSweeps(scene.rig, masks, view, right, wrong);
  EXPECT_EQ(comparison.differing_pixels, 2);
  EXPECT_EQ(comparison.unexplained_pixels, 2);
}

TEST(PlaneSweep, WrongInputIsNamed) {
  const BallScene scene = MakeBallScene(core::UnseenPolicy::kOutside);
  const auto view = PinholeView({450.0, 250.0, 300.0}, Vector3d::Zero());
  auto masks = Ready(scene.masks);
  EXPECT_THROW((void)SweepPlanes(scene.rig, masks, view, {.spacing_mm = 0.0}), core::PreconditionError);
  EXPECT_THROW((void)SweepPlanes(scene.rig, masks, view, {.undistortion_grid = -1}), core::PreconditionError);
  EXPECT_THROW((void)SweepPlanes(scene.rig, masks, view, {.spacing_mm = 1e-4}), core::Error);
  EXPECT_THROW((void)SweepPlanes(scene.rig, std::span(masks).first(2), view), core::PreconditionError);
  masks[1] = {core::BitMask(10, 10), {}};
  try {
    (void)SweepPlanes(scene.rig, masks, view);
    FAIL() << "took a mask of another size";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("'cam2'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace elbowroom::recon
