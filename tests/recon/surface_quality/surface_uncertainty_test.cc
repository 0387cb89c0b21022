// The uncertainty of each pixel's surface, held to the error budget itself and to shifted silhouettes.
#include "recon/surface_quality/surface_uncertainty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/error.h"
#include "core/spread.h"
#include "recon/contours/silhouette.h"
#include "recon/error_budget/hull_errors.h"
#include "tests/recon/surface_quality/quality_scenes.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// Between the table's nodes; what SurfaceUncertainty promises.
constexpr double kTableShare = 0.002;

Vector3d PlaceOf(const ViewRays& rays, const HullView& picture, std::size_t at) {
  const auto width = static_cast<std::size_t>(picture.width_px);
  return rays.view_from_world().Inverse() * PlaceInView(rays, static_cast<int>(at % width),
                                                        static_cast<int>(at / width),
                                                        static_cast<double>(picture.depth_mm[at]));
}

TEST(SurfaceUncertainty, IsThatOfTheConeThatBoundsEachPixel) {
  Random random(2501);
  for (const bool is_soft : {false, true}) {
    for (const QualityScene& scene : QualityScenes(is_soft)) {
      const SurfaceUncertainty fast(*scene.rig, {DrawCovariance(*scene.rig, &random), 0.2});
      int judged = 0;
      double worst = 0.0;
      for (const ViewRays& rays : ViewsOf(scene)) {
        const HullView picture = ViewHull(*scene.hull, rays);
        const SurfaceValues values = fast.Of(*scene.hull, picture, rays);
        for (std::size_t at = 0; at < values.size(); ++at) {
          ASSERT_EQ(values[at].has_value(), picture.surface[at].camera().has_value());
          if (!values[at]) continue;
          const double exact =
              fast.errors()
                  .OfCone(*picture.surface[at].camera(), picture.normal_in_world[at].cast<double>(),
                          PlaceOf(rays, picture, at), is_soft)
                  .ExpandedMm();
          ++judged;
          worst = std::max(worst, std::abs(static_cast<double>(*values[at]) / exact - 1.0));
        }
      }
      std::printf("%-28s %s: %5d pixels, off by %.5f at most\n", scene.name.c_str(),
                  is_soft ? "located" : "pixels ", judged, worst);
      EXPECT_GT(judged, 500) << scene.name;
      EXPECT_LE(worst, kTableShare) << scene.name;
    }
  }
}

// What a verdict would allow for of a part that stands off the surface there. That looks for all silhouettes
// near the place, whose normals are fitted to several vertices of a contour.
TEST(SurfaceUncertainty, IsWhatAVerdictAllowsFor) {
  Random random(2502);
  for (const QualityScene& scene : QualityScenes()) {
    const core::RigErrors errors{DrawCovariance(*scene.rig, &random), 0.2};
    const SurfaceUncertainty fast(*scene.rig, errors);
    const HullErrors verdicts(*scene.rig, errors);
    std::vector<double> off;
    for (const ViewRays& rays : ViewsOf(scene)) {
      const HullView picture = ViewHull(*scene.hull, rays);
      const SurfaceValues values = fast.Of(*scene.hull, picture, rays);
      for (std::size_t at = 0; at < values.size(); at += 3) {
        if (!values[at]) continue;
        const Vector3d x = PlaceOf(rays, picture, at);
        const double allowed_mm =
            verdicts.At(*scene.hull, x, x + 10.0 * picture.normal_in_world[at].cast<double>()).ExpandedMm();
        off.push_back(std::abs(static_cast<double>(*values[at]) / allowed_mm - 1.0));
      }
    }
    ASSERT_GT(off.size(), 200U);
    std::ranges::sort(off);
    const double median = core::PercentileOf(off, 0.5), p95 = core::PercentileOf(off, 0.95);
    std::printf("%-28s against a verdict's budget: median %.4f, 95 %% %.3f\n", scene.name.c_str(), median,
                p95);
    EXPECT_LE(median, 0.02) << scene.name;
    EXPECT_LE(p95, 0.25)
        << scene.name;  // where two silhouettes meet within a pixel, both count in the verdict
  }
}

// Of exact cameras: U is as much as the surface moves when its silhouette's boundary does by 2 sigma.
TEST(SurfaceUncertainty, OfPixelsIsTheWidthOfABoundarysError) {
  const QualityScene scene = MakeQualityScene(1, 1);
  const Eigen::Index count = DrawCovariance(*scene.rig, std::make_unique<Random>(1).get()).rows();
  const SurfaceUncertainty fast(*scene.rig, {Eigen::MatrixXd::Zero(count, count), 0.2});
  const ViewRays rays = ViewsOf(scene)[0];
  const HullView picture = ViewHull(*scene.hull, rays);
  const SurfaceValues values = fast.Of(*scene.hull, picture, rays);
  for (std::size_t at = 0; at < values.size(); at += 7) {
    if (!values[at]) continue;
    // The place moves outwards by U; its pixel in that camera moves by 2 * 0.2 px across the boundary.
    const core::CameraModel& camera = scene.rig->cameras[*picture.surface[at].camera()];
    const Vector3d x = PlaceOf(rays, picture, at);
    const Vector3d out = picture.normal_in_world[at].cast<double>();
    const auto before = camera.Project(x),
               after = camera.Project(x + 0.01 * static_cast<double>(*values[at]) * out);
    ASSERT_TRUE(before && after);
    EXPECT_NEAR(100.0 * (*after - *before).norm(), 0.4,
                0.4 * 0.03);  // a normal is across the ray to 1 degree
  }
}

TEST(SurfaceUncertainty, HasNoValueOnFacesOfTheWorkspaceAndOffTheHull) {
  const QualityScene scene = MakeQualityScene(1, 0);
  auto cut = std::make_shared<core::Rig>(*scene.rig);
  cut->workspace_mm.max().z() = scene.middle_in_world.z();
  const auto silhouettes = scene.hull->silhouettes();
  const VisualHull open(cut, std::vector(silhouettes.begin(), silhouettes.end()));
  Random random(2503);
  const SurfaceUncertainty fast(*scene.rig, {DrawCovariance(*scene.rig, &random), 0.2});
  const ViewRays rays = ViewsOf(scene)[0];
  const HullView picture = ViewHull(open, rays);
  const SurfaceValues values = fast.Of(open, picture, rays);
  int faces = 0, others = 0;
  for (std::size_t at = 0; at < values.size(); ++at) {
    if (!picture.surface[at].is_hit()) {
      EXPECT_FALSE(values[at]);
    } else if (!picture.surface[at].camera()) {
      EXPECT_FALSE(values[at]);
      ++faces;
    } else {
      others += values[at] ? 1 : 0;
    }
  }
  EXPECT_GT(faces, 50);
  EXPECT_GT(others, 50);
  EXPECT_THROW((void)fast.Of(open, ViewHull(open, rays, {.surfaces = false}), rays), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
