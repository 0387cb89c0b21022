// Which cameras see a place of the surface, held to exact rays from each camera.
#include "recon/surface_quality/surface_coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "recon/appearance/orbit_camera.h"
#include "recon/calibration/rig_uncertainty.h"
#include "recon/hull/ray_crossings.h"
#include "recon/synthetic/solids.h"
#include "tests/oracles/coverage_mask.h"
#include "tests/recon/surface_quality/quality_scenes.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// What SurfaceCoverage promises beside rims, in pixels of its picture of the hull.
constexpr double kRimPx = 1.0;

double ShrunkBy(const core::CameraModel& camera) {
  const int longer_px = std::max(camera.width_px(), camera.height_px());
  return std::max(1.0, static_cast<double>(longer_px) / SurfaceCoverage::kMostPx);
}

// The slow way: by its definition, with the hull's own intervals along the line of sight through a place of
// the camera's picture.
bool SeesThrough(const VisualHull& hull, const core::CameraModel& camera, const Vector2d& pixel,
                 double z_mm) {
  const auto uv = camera.NormalisedFromPixel(pixel);
  if (!uv) return true;
  const Vector3d along_cam = uv->homogeneous();
  const Ray ray{camera.center_in_world(),
                (camera.cam_from_world().rotation.transpose() * along_cam).normalized()};
  const std::optional<double> first = FirstInside(hull, ray);
  if (!first) return true;
  const double first_z_mm = *first / along_cam.norm();
  const Eigen::Matrix3d& matrix = camera.calibration().camera_matrix;
  return z_mm <= first_z_mm + z_mm * ShrunkBy(camera) / std::min(matrix(0, 0), matrix(1, 1));
}

struct Answers {
  bool exact = false;
  bool is_sure = true;  // the same everywhere near the place in the camera's picture
};

Answers Ask(const VisualHull& hull, const core::CameraModel& camera, const Vector3d& x_in_world) {
  const double z_mm = (camera.cam_from_world() * x_in_world).z();
  const Vector2d pixel = *camera.Project(x_in_world);
  Answers answers{SeesThrough(hull, camera, pixel, z_mm), true};
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const Vector2d beside = 0.5 * kRimPx * ShrunkBy(camera) * Vector2d(i, j);
      if (SeesThrough(hull, camera, pixel + beside, z_mm) != answers.exact) answers.is_sure = false;
    }
  }
  return answers;
}

TEST(SurfaceCoverage, IsThatOfExactRaysButBesideRims) {
  for (const QualityScene& scene : QualityScenes()) {
    SurfaceCoverage fast(*scene.rig);
    fast.LookAt(*scene.hull);
    int asked = 0, sure = 0, wrong = 0, as_exact = 0, pixels = 0, same_count = 0;
    for (const ViewRays& rays : ViewsOf(scene)) {
      const HullView picture = ViewHull(*scene.hull, rays);
      const SurfaceValues values = fast.Of(*scene.hull, picture, rays);
      for (int y = 0; y < picture.height_px; y += 5) {
        for (int x = 0; x < picture.width_px; x += 5) {
          const auto at = static_cast<std::size_t>(y * picture.width_px + x);
          if (!values[at]) continue;
          const Vector3d place = rays.view_from_world().Inverse() *
                                 PlaceInView(rays, x, y, static_cast<double>(picture.depth_mm[at]));
          int exact_count = 1;  // the camera whose silhouette ends there
          for (core::CameraIndex i = 0; i < scene.rig->cameras.size(); ++i) {
            const core::CameraModel& camera = scene.rig->cameras[i];
            if (i == *picture.surface[at].camera() || !IsInPicture(camera, place)) continue;
            const Answers slow = Ask(*scene.hull, camera, place);
            const bool sees = fast.Sees(i, place, picture.normal_in_world[at].cast<double>());
            exact_count += slow.exact ? 1 : 0;
            ++asked;
            sure += slow.is_sure ? 1 : 0;
            wrong += slow.is_sure && sees != slow.exact ? 1 : 0;
            as_exact += sees == slow.exact ? 1 : 0;
          }
          ++pixels;
          same_count += exact_count == static_cast<int>(*values[at]) ? 1 : 0;
        }
      }
    }
    std::printf(
        "%-28s %5d lines of sight: %.1f %% sure, %d of them wrong; %.2f %% as exact rays; %.1f %% of %d "
        "pixels have the exact count\n",
        scene.name.c_str(), asked, 100.0 * sure / asked, wrong, 100.0 * as_exact / asked,
        100.0 * same_count / pixels, pixels);
    EXPECT_EQ(wrong, 0) << scene.name;
    EXPECT_GT(sure, asked / 2) << scene.name;
    EXPECT_GT(pixels, 50) << scene.name;
  }
}

// Two balls on a line with a camera: it sees the front of the near one, and nothing of the far one.
TEST(SurfaceCoverage, WhatStandsBeforeAPlaceTakesItsCameraAway) {
  const auto rig = MakeQualityScene(1, 0).rig;
  const Vector3d middle = rig->workspace_mm.center();
  const core::CameraModel& camera = rig->cameras[1];
  const Vector3d towards = (camera.center_in_world() - middle).normalized();
  const Vector3d grey = Vector3d::Constant(200.0);
  const Vector3d near_middle = middle + 90.0 * towards;
  const std::vector<Solid> solids = {
      {Sphere{70.0}, {Eigen::Matrix3d::Identity(), near_middle}, grey},
      {Sphere{30.0}, {Eigen::Matrix3d::Identity(), middle - 90.0 * towards}, grey}};
  std::vector<core::SoftMask> masks;
  for (const core::CameraModel& seen_by : rig->cameras)
    masks.push_back(oracles::CoverageMask(seen_by, solids, 2.0));
  const VisualHull hull = MakeVisualHull(rig, masks);
  SurfaceCoverage coverage(*rig);
  EXPECT_FALSE(coverage.Sees(1, near_middle + 70.0 * towards, towards));  // nobody has looked yet
  coverage.LookAt(hull);
  const Ray ray{camera.center_in_world(), -towards};
  const std::vector<HullInterval> in_hull = IntervalsInHull(hull, ray);
  ASSERT_EQ(in_hull.size(), 2U);
  const auto sees = [&](double at_mm, const Vector3d& normal_in_world) {
    return coverage.Sees(1, ray.origin_in_world + at_mm * ray.direction_in_world, normal_in_world);
  };
  EXPECT_TRUE(sees(in_hull[0].from_mm, towards));
  EXPECT_FALSE(sees(in_hull[0].to_mm, -towards));
  EXPECT_FALSE(sees(in_hull[1].from_mm, towards));
  EXPECT_FALSE(sees(-1000.0, towards));  // behind the camera
}

}  // namespace
}  // namespace elbowroom::recon
