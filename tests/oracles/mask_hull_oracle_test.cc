#include "tests/oracles/mask_hull_oracle.h"
#include "recon/contours/silhouette.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "recon/hull/visual_hull.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/oracles/analytic_hull.h"
#include "tests/oracles/camera_projection.h"
#include "tests/oracles/coverage_mask.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::oracles {
namespace {

using Eigen::Vector3d;

std::vector<core::SoftMask> Soft(std::span<const core::BitMask> masks) {
  std::vector<core::SoftMask> soft;
  for (const core::BitMask& mask : masks) soft.push_back({mask, {}});
  return soft;
}

TEST(CameraProjection, IsTheCameraModelsOwn) {
  recon::Random random(21);
  constexpr double kRelative = 1e-10;  // of positions of up to 1e5 px in double
  int seen = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const core::CameraModel camera =
        recon::RandomCamera(&random, static_cast<recon::LensKind>(trial % recon::kLensKinds));
    for (int i = 0; i < 50; ++i) {
      const Vector3d x = camera.center_in_world() + random.LogUniform(10.0, 1e4) * random.Direction();
      const auto expected = camera.Project(x);
      const auto found = Project(camera, x.cast<long double>());
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!expected) continue;
      ++seen;
      EXPECT_LT((found->cast<double>() - *expected).norm(), kRelative * (1e3 + expected->norm()));
    }
  }
  EXPECT_GT(seen, 200);
}

// Beside pixels that the lens doesn't bring into the picture: there the program's outline goes from pixel to
// pixel, the oracle's along the rim of the lens's domain.
bool IsBesideUnseen(const recon::VisualHull& hull, const Vector3d& x) {
  constexpr int kNearPx = 2;
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const std::optional<core::BitMask>& unseen = hull.silhouettes()[i]->plane().unseen_pixels();
    const std::optional<Eigen::Vector2d> pixel = hull.rig().cameras[i].Project(x);
    if (!unseen || !pixel) continue;
    const auto at_x = static_cast<int>(std::lround(pixel->x())),
               at_y = static_cast<int>(std::lround(pixel->y()));
    for (int py = std::max(at_y - kNearPx, 0); py <= std::min(at_y + kNearPx, unseen->height_px() - 1); ++py)
      for (int px = std::max(at_x - kNearPx, 0); px <= std::min(at_x + kNearPx, unseen->width_px() - 1); ++px)
        if (unseen->At(px, py)) return true;
  }
  return false;
}

TEST(MaskHullOracle, AgreesWithTheVolumeQuery) {
  recon::Random random(22);
  constexpr double kLensBendPx = 2e-3;  // of a segment of a pixel, by the wildest of these lenses
  int inside = 0;
  for (int trial = 0; trial < 60 * test_support::SoakScale(); ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const recon::RandomScene scene = trial % 3 == 0 ? recon::MakeRandomScene(&random)
                                                    : recon::MakeRingScene(&random, 1 + trial % 5, unseen);
    const recon::VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    const MaskHullOracle oracle(*scene.rig, Soft(scene.masks), BoundaryConvention::kMarchingSquares);
    for (int i = 0; i < 300; ++i) {
      const Vector3d x = 1.1 * random.PointIn(scene.rig->workspace_mm);
      // The program's contours are straight between crossings in the plane without the lens's bend.
      const bool is_sure = oracle.Contains(x.cast<long double>(), kLensBendPx) ==
                           oracle.Contains(x.cast<long double>(), -kLensBendPx);
      if (!is_sure || IsBesideUnseen(hull, x)) continue;
      const bool expected = oracle.Contains(x.cast<long double>());
      inside += expected ? 1 : 0;
      ASSERT_EQ(hull.Contains(x), expected) << "trial " << trial << " at " << x.transpose();
    }
  }
  EXPECT_GT(inside, 500);
}

TEST(MaskHullOracle, UnderAbstainACameraSeesAsFarAsItsOutline) {
  core::CameraCalibration c;
  c.name = "camera";
  c.image_width_px = 8, c.image_height_px = 6;
  c.camera_matrix << 10.0, 0.0, 4.0, 0.0, 10.0, 3.0, 0.0, 0.0, 1.0;
  const core::CameraModel camera(c);
  const auto rig = std::make_shared<const core::Rig>(core::Rig{
      "one", {Vector3d::Constant(-1e3), Vector3d::Constant(1e3)}, core::UnseenPolicy::kAbstain, {camera}});
  std::vector<core::SoftMask> all = {{core::BitMask(8, 6), {}}};
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) all[0].mask.Set(x, y, true);
  const recon::VisualHull hull = recon::MakeVisualHull(rig, all);
  const MaskHullOracle oracle(*rig, all, BoundaryConvention::kMarchingSquares),
      squares(*rig, all, BoundaryConvention::kPixelSquares);
  int tips = 0;
  for (double x_px = -0.73; x_px < 8.0; x_px += 0.05) {
    for (double y_px = -0.73; y_px < 6.0; y_px += 0.05) {
      const Vector3d x_in_world(100.0 * (x_px - 4.0) / 10.0, 100.0 * (y_px - 3.0) / 10.0, 100.0);
      const bool is_seen = oracle.Contains(x_in_world.cast<long double>());
      ASSERT_EQ(hull.Contains(x_in_world), is_seen) << x_px << ' ' << y_px;
      tips += squares.Contains(x_in_world.cast<long double>()) != is_seen ? 1 : 0;
    }
  }
  EXPECT_GT(tips, 4 * 30);  // four triangles of an eighth of a pixel, 400 places a pixel
}

TEST(MaskHullOracle, FirstSurfaceIsTheSameWithoutPassingOverAnything) {
  recon::Random random(23);
  constexpr double kStepMm = 0.5;
  int hits = 0;
  for (const auto convention : {BoundaryConvention::kPixelSquares, BoundaryConvention::kMarchingSquares}) {
    for (int trial = 0; trial < 12; ++trial) {
      const recon::RandomScene scene =
          recon::MakeRingScene(&random, random.Whole(2, 5), core::UnseenPolicy::kOutside);
      const MaskHullOracle oracle(*scene.rig, Soft(scene.masks), convention);
      for (int i = 0; i < 6; ++i) {
        const Vector3d origin = 2.0 * random.PointIn(scene.rig->workspace_mm);
        const recon::Ray ray{origin, (0.3 * random.PointIn(scene.rig->workspace_mm) - origin).normalized()};
        const auto span = ClipToBox(scene.rig->workspace_mm, ray, 0.0);
        if (!span) continue;
        std::optional<double> truth;
        for (int step = 0; !truth && span->first + step * kStepMm < span->second; ++step) {
          const long double t = span->first + step * kStepMm;
          if (oracle.Contains(PointAt(ray, t))) truth = static_cast<double>(t);
        }
        const auto found = oracle.FirstSurface(ray, 0.0, {.step_mm = kStepMm});
        ASSERT_EQ(found.has_value(), truth.has_value());
        if (!found) continue;
        ++hits;
        EXPECT_LE(*found, *truth + 1e-6);
        EXPECT_GE(*found, *truth - kStepMm - 1e-6);
      }
    }
  }
  EXPECT_GT(hits, 30);
}

TEST(MaskHullOracle, OfCoverageMasksLiesWithinAFractionOfAPixelOfTheAnalyticHull) {
  // PaperRig: a pixel is up to 5.8 mm high; the coverage's boundary is good to a tenth of one, and a view
  // ray meets the hull at a slant.
  constexpr double kTypicalMm = 0.5;
  const core::Rig rig = recon::PaperRig();
  const auto solids = recon::AllSolids(recon::DemoSceneAt(5.0).objects);
  std::vector<core::SoftMask> masks;
  for (const core::CameraModel& camera : rig.cameras) masks.push_back(CoverageMask(camera, solids));
  const AnalyticHull truth(rig, solids);
  const MaskHullOracle oracle(rig, masks, BoundaryConvention::kMarchingSquares);
  const MaskHullOracle squares(rig, masks, BoundaryConvention::kPixelSquares);
  const Vector3d eye(300.0, -900.0, 700.0);
  std::vector<double> error_mm, squares_error_mm;
  for (double x_mm = -20.0; x_mm < 350.0; x_mm += 7.0) {
    for (double z_mm = 120.0; z_mm < 280.0; z_mm += 13.0) {
      const recon::Ray ray{eye, (Vector3d(x_mm, 0.0, z_mm) - eye).normalized()};
      const auto expected = truth.FirstSurface(ray), found = oracle.FirstSurface(ray),
                 coarse = squares.FirstSurface(ray);
      if (!expected || !found || !coarse) continue;
      error_mm.push_back(std::abs(*found - *expected));
      squares_error_mm.push_back(std::abs(*coarse - *expected));
    }
  }
  ASSERT_GT(error_mm.size(), 100U);
  const auto median = [](std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
  };
  EXPECT_LT(median(error_mm), kTypicalMm);
  EXPECT_GT(median(squares_error_mm), 2.0 * median(error_mm));
}

TEST(MaskHullOracle, GrowsAndShrinksWithItsSilhouettes) {
  recon::Random random(24);
  int between = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const recon::RandomScene scene = recon::MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
    const MaskHullOracle oracle(*scene.rig, Soft(scene.masks), BoundaryConvention::kMarchingSquares);
    for (int i = 0; i < 10; ++i) {
      const Vector3d origin = 2.0 * random.PointIn(scene.rig->workspace_mm);
      const recon::Ray ray{origin, (0.3 * random.PointIn(scene.rig->workspace_mm) - origin).normalized()};
      const auto grown = oracle.FirstSurface(ray, 0.1), exact = oracle.FirstSurface(ray),
                 shrunk = oracle.FirstSurface(ray, -0.1);
      if (shrunk) {
        ASSERT_TRUE(exact.has_value());
      }
      if (exact) {
        ASSERT_TRUE(grown.has_value());
      }
      if (exact) {
        EXPECT_LE(*grown, *exact);
      }
      if (shrunk) {
        EXPECT_GE(*shrunk, *exact);
      }
      between += exact && *grown < *exact - 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(between, 10);
}

}  // namespace
}  // namespace elbowroom::oracles
