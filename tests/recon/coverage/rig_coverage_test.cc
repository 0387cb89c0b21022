// The four quantities at single places, and their figures over many.
#include "recon/coverage/rig_coverage.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "core/error.h"
#include "core/spread.h"
#include "recon/calibration/lens_projection.h"
#include "recon/coverage/coverage_figures.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/recon/coverage/ball_rigs.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

TEST(Spread, IsOfSortedValues) {
  std::vector<double> values;
  for (int i = 100; i >= 0; --i) values.push_back(i);
  const auto spread = core::SpreadOf(values);
  ASSERT_TRUE(spread.has_value());
  EXPECT_EQ(spread->median, 50.0);
  EXPECT_EQ(spread->p95, 95.0);
  EXPECT_EQ(spread->max, 100.0);
  EXPECT_FALSE(core::SpreadOf({}).has_value());
  EXPECT_THROW((void)core::PercentileOf({}, 0.5), core::PreconditionError);
}

TEST(PixelWidth, OfAPinholeIsDepthOverFocalLength) {
  const std::array<Vector3d, 1> eyes = {Vector3d(0.0, 0.0, 1500.0)};
  const core::CameraModel camera = RigAt(eyes, 750.0, Cube(100.0)).cameras[0];
  const LensParameters lens = LensParametersOf(camera.calibration());
  for (const Vector3d& x : {Vector3d(0, 0, 0), Vector3d(300, -200, 0), Vector3d(-400, 100, 0)})
    EXPECT_NEAR(PixelWidthMm(lens, camera.cam_from_world(), x), 2.0, 1e-9);
  EXPECT_NEAR(PixelWidthMm(lens, camera.cam_from_world(), {10.0, 20.0, 750.0}), 1.0, 1e-9);
  EXPECT_EQ(PixelWidthMm(lens, camera.cam_from_world(), {0.0, 0.0, 1600.0}), 0.0);
}

TEST(PixelWidth, IsTheLargestShiftBetweenNeighbouringPixels) {
  constexpr double kCurvature = 0.01;  // a pixel is small, but the lens bends within it
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const core::CameraModel camera = RandomCamera(&random, LensKind::kTangential);
    const LensParameters lens = LensParametersOf(camera.calibration());
    const Eigen::Vector2d pixel(random.Uniform(0.3, 0.7) * camera.width_px(),
                                random.Uniform(0.3, 0.7) * camera.height_px());
    const auto ray = camera.NormalisedFromPixel(pixel);
    if (!ray) continue;
    const double depth_mm = random.Uniform(100.0, 3000.0);
    double widest_mm = 0.0;
    for (int i = 0; i < 360; ++i) {
      const double turn = 0.0174533 * i;
      const auto beside =
          camera.NormalisedFromPixel(pixel + 0.01 * Eigen::Vector2d(std::cos(turn), std::sin(turn)));
      if (beside) widest_mm = std::max(widest_mm, 100.0 * depth_mm * (*beside - *ray).norm());
    }
    const Vector3d x = camera.cam_from_world().Inverse() * (depth_mm * ray->homogeneous());
    EXPECT_NEAR(PixelWidthMm(lens, camera.cam_from_world(), x) / widest_mm, 1.0, kCurvature);
  }
}

TEST(RigCoverage, ANodeHasWhatItsCamerasGive) {
  const std::array<Vector3d, 2> eyes = {Vector3d(1000.0, 0.0, 0.0), Vector3d(0.0, 2000.0, 0.0)};
  CalibratedRig rig{RigAt(eyes, 1000.0, Cube(800.0))};
  rig.noise_px = 0.5;
  BallHull::Scratch scratch;
  const CoverageNode middle = RigCoverage(rig, {}).At(Vector3d::Zero(), &scratch);
  EXPECT_EQ(middle.cameras, 2);
  EXPECT_TRUE(middle.in_reach && middle.has_sigma && middle.has_phantom);
  EXPECT_NEAR(middle.footprint_mm, 2.0, 1e-6);  // the farther camera's
  // Along x only the far camera says something, along y the near one, along z both: sums of 1 / variance.
  const double near = 0.5 * 1.0, far = 0.5 * 2.0;
  const double z2 = 1.0 / (1.0 / (near * near) + 1.0 / (far * far));
  // Triangulation weighs pixels alike, which is the best for equal noise.
  EXPECT_NEAR(middle.sigma_mm, std::sqrt(near * near + far * far + z2), 1e-5);
  const CoverageNode aside = RigCoverage(rig, {}).At({600.0, 0.0, 300.0}, &scratch);
  EXPECT_EQ(aside.cameras, 1);
  EXPECT_FALSE(aside.has_sigma || aside.in_reach || aside.has_phantom);
  EXPECT_GT(aside.footprint_mm, 0.0F);
  rig.rig.unseen = core::UnseenPolicy::kAbstain;
  const CoverageNode abstained = RigCoverage(rig, {}).At({600.0, 0.0, 300.0}, &scratch);
  EXPECT_TRUE(abstained.in_reach && abstained.has_phantom);
  EXPECT_GT(abstained.phantom, middle.phantom);
}

TEST(CoverageFigures, CountWhatHasNoValue) {
  std::vector<CoverageNode> nodes(4);
  nodes[0] = {1.0F, 2.0F, 0.3F, 3, true, true, true};
  nodes[1] = {3.0F, 4.0F, 0.5F, 2, true, true, true};
  nodes[2] = {0.0F, 5.0F, 0.0F, 1, false, false, false};
  const CoverageFigures figures = FiguresOf(nodes);
  EXPECT_EQ(figures.nodes, 4U);
  EXPECT_EQ(figures.uncertainty_mm->max, 3.0);
  EXPECT_EQ(figures.footprint_mm->max, 5.0);
  EXPECT_EQ(figures.cameras_seeing->max, 3.0);
  EXPECT_EQ(figures.fewest_cameras, 0);
  EXPECT_EQ(figures.seen_share, 0.5);
  EXPECT_EQ(figures.unseen_share, 0.25);
  EXPECT_EQ(figures.reach_share, 0.5);
  EXPECT_EQ(figures.without_sigma, 2U);
  EXPECT_EQ(figures.worst_sigma, 1U);
  EXPECT_EQ(figures.worst_phantom, 1U);
  EXPECT_FALSE(FiguresOf(std::span(nodes).subspan(3)).uncertainty_mm.has_value());
  EXPECT_EQ(FiguresOf({}).nodes, 0U);
}

TEST(CoverageGrid, NumbersItsNodesAsItFindsThem) {
  const CoverageGrid grid = GridOver({Vector3d(-10, 0, 5), Vector3d(30, 20, 65)}, 20.0);
  EXPECT_EQ(grid.counts, Eigen::Vector3i(3, 2, 4));
  EXPECT_EQ(grid.size(), 24U);
  EXPECT_EQ(grid.PointAt(grid.NodeAt(2, 1, 3)), Vector3d(30, 20, 65));
  EXPECT_EQ(grid.Points()[grid.NodeAt(1, 0, 2)], Vector3d(10, 0, 45));
  EXPECT_THROW((void)GridOver(Cube(1.0), 0.0), core::PreconditionError);
}

TEST(RigCoverage, TheSameForAnyOrderAndStopsWhenAsked) {
  const CalibratedRig rig{FourCameraRig()};
  const std::vector<Vector3d> points = GridOver(rig.rig.workspace_mm, 100.0).Points();
  const RigCoverage coverage(rig, {});
  const std::vector<CoverageNode> nodes = coverage.At(points);
  BallHull::Scratch scratch;
  for (std::size_t i = 0; i < points.size(); i += 7) {
    const CoverageNode alone = coverage.At(points[i], &scratch);
    EXPECT_EQ(nodes[i].sigma_mm, alone.sigma_mm);
    EXPECT_EQ(nodes[i].phantom, alone.phantom);
  }
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)coverage.At(points, {}, source.get_token()), core::Error);
}

}  // namespace
}  // namespace elbowroom::recon
