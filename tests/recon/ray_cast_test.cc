#include "recon/ray_cast.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <optional>

#include "core/error.h"
#include "tests/recon/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kMarchMm = 0.02;    // of the brute-force march
constexpr double kRefinedMm = 2e-6;  // what ray_cast.h promises, twice
constexpr double kDirectionTolerance = 1e-6;

core::CameraModel ViewCamera(int width_px, int height_px, const Vector3d& eye, const Vector3d& target) {
  core::CameraCalibration c;
  c.name = "view";
  c.image_width_px = width_px;
  c.image_height_px = height_px;
  c.camera_matrix << 1.1 * width_px, 0.0, 0.5 * width_px, 0.0, 1.1 * width_px, 0.5 * height_px, 0.0, 0.0, 1.0;
  c.distortion_coefficients = {-0.1, 0.02, 1e-3, 1e-3, 0.0};
  c.cam_from_world = core::CamFromWorldLookingAt(eye, target);
  return core::CameraModel(std::move(c));
}

Ray RandomRay(Random* random, const core::Rig& rig) {
  const Vector3d origin = 2.0 * random->PointIn(rig.workspace_mm);
  const Vector3d target = 0.3 * random->PointIn(rig.workspace_mm);
  return {origin, (target - origin).normalized()};
}

// Step by step until Contains() says `wanted`.
std::optional<double> MarchByHand(const VisualHull& hull, const Ray& ray, double to_mm, bool wanted) {
  for (double t_mm = 0.0; t_mm <= to_mm; t_mm += kMarchMm) {
    if (hull.Contains(ray.origin_in_world + t_mm * ray.direction_in_world) == wanted) return t_mm;
  }
  return std::nullopt;
}

// Whether the point at t is within the refinement of a change along the ray.
void ExpectCrossing(const VisualHull& hull, const Ray& ray, double t_mm, bool wanted) {
  EXPECT_EQ(hull.Contains(ray.origin_in_world + t_mm * ray.direction_in_world), wanted);
  EXPECT_NE(hull.Contains(ray.origin_in_world + (t_mm - kRefinedMm) * ray.direction_in_world), wanted);
}

TEST(FirstInside, IsTheFirstCrossingOfABruteForceMarch) {
  Random random(4001);
  int hits = 0;
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    for (int trial = 0; trial < 12; ++trial) {
      const RandomScene scene = MakeRingScene(&random, random.Whole(1, 5), unseen);
      const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
      for (int i = 0; i < 12; ++i) {
        const Ray ray = RandomRay(&random, *scene.rig);
        constexpr double kToMm = 900.0;
        RayOptions options;
        options.step_mm = kMarchMm;
        options.to_mm = kToMm;
        const std::optional<double> found = FirstInside(hull, ray, options);
        const std::optional<double> truth = MarchByHand(hull, ray, kToMm, true);
        if (truth) {
          ++hits;
          ASSERT_TRUE(found.has_value());
          // Only a sliver shorter than either's step may be seen by one and not by the other.
          ASSERT_LE(*found, *truth + kRefinedMm);
        }
        if (found && *found > 0.0) ExpectCrossing(hull, ray, *found, true);
        if (found && truth && *found < *truth - kMarchMm) {
          EXPECT_FALSE(hull.Contains(ray.origin_in_world + (*found + kMarchMm) * ray.direction_in_world));
        }
      }
    }
  }
  EXPECT_GT(hits, 100);
}

TEST(FirstOutside, EndsTheStretchThatFirstInsideBegins) {
  Random random(4002);
  int asked = 0;
  for (int trial = 0; trial < 15; ++trial) {
    const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (int i = 0; i < 20; ++i) {
      const Ray ray = RandomRay(&random, *scene.rig);
      const std::optional<double> in = FirstInside(hull, ray);
      if (!in) continue;
      RayOptions options;
      options.from_mm = *in;
      options.step_mm = kMarchMm;
      const std::optional<double> out = FirstOutside(hull, ray, options);
      ASSERT_TRUE(out.has_value());
      ExpectCrossing(hull, ray, *out, false);
      const Ray from_in{ray.origin_in_world + *in * ray.direction_in_world, ray.direction_in_world};
      const std::optional<double> truth = MarchByHand(hull, from_in, 900.0, false);
      ASSERT_TRUE(truth.has_value());
      ASSERT_LE(*out - *in, *truth + kRefinedMm);
      ++asked;
    }
  }
  EXPECT_GT(asked, 100);
}

TEST(FirstInside, LimitsAndStarts) {
  Random random(4003);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  std::optional<Ray> through;
  for (int i = 0; i < 1000 && !through; ++i) {
    const Ray ray = RandomRay(&random, *scene.rig);
    if (FirstInside(hull, ray).value_or(0.0) > 1.0) through = ray;
  }
  ASSERT_TRUE(through.has_value());
  const double hit_mm = *FirstInside(hull, *through);
  RayOptions options;
  options.to_mm = hit_mm - 0.01;
  EXPECT_FALSE(FirstInside(hull, *through, options).has_value());
  options = {};
  options.from_mm = hit_mm + 1e-3;
  EXPECT_EQ(FirstInside(hull, *through, options), options.from_mm) << "a ray that starts inside";
  EXPECT_FALSE(FirstInside(hull, {through->origin_in_world, -through->direction_in_world}).has_value());
  options = {};
  options.step_mm = 0.0;
  EXPECT_THROW((void)FirstInside(hull, *through, options), core::PreconditionError);
  EXPECT_THROW((void)FirstOutside(hull, *through, options), core::PreconditionError);
}

TEST(FirstInside, RaysThroughACameraCentre) {
  Random random(4004);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kAbstain);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  for (const core::CameraModel& camera : scene.rig->cameras) {
    for (int i = 0; i < 30; ++i) {
      const Vector3d target = 0.4 * random.PointIn(scene.rig->workspace_mm);
      const Vector3d direction = (target - camera.center_in_world()).normalized();
      const Ray ray{camera.center_in_world() - 50.0 * direction, direction};
      RayOptions options;
      options.step_mm = kMarchMm;
      options.to_mm = 1500.0;
      const std::optional<double> found = FirstInside(hull, ray, options);
      const std::optional<double> truth = MarchByHand(hull, ray, options.to_mm, true);
      if (!truth) continue;
      ASSERT_TRUE(found && *found <= *truth + kRefinedMm);
    }
  }
}

// The picture as one ray a pixel makes it.
void ExpectEqualsSingleRays(const VisualHull& hull, const core::CameraModel& view, double step_mm) {
  const HullView picture = ViewHull(hull, view, step_mm);
  std::int64_t hits = 0;
  int different = 0;
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const auto pixel = static_cast<std::size_t>(y * picture.width_px + x);
      const float depth_mm = picture.depth_mm[pixel];
      hits += depth_mm > 0.0F ? 1 : 0;
      const auto normalised = view.NormalisedFromPixel({x, y});
      if (!normalised) {
        EXPECT_EQ(depth_mm, 0.0F);
        continue;
      }
      const Vector3d in_cam = normalised->homogeneous().normalized();
      const Ray ray{view.center_in_world(), view.cam_from_world().rotation.transpose() * in_cam};
      RayOptions options;
      options.step_mm = step_mm;
      const std::optional<double> alone = FirstInside(hull, ray, options);
      if (depth_mm > 0.0F) {
        EXPECT_NEAR(picture.normal_in_world[pixel].norm(), 1.0, kDirectionTolerance);
        const Vector3d hit = ray.origin_in_world + (depth_mm / in_cam.z() + 1e-3) * ray.direction_in_world;
        const Vector3d before = ray.origin_in_world + (depth_mm / in_cam.z() - 1e-3) * ray.direction_in_world;
        if (!hull.Contains(hit) && !hull.Contains(before)) ++different;  // grazes less than a micrometre
      }
      // Float depth at 2 m resolves 1e-4 mm; stretches shorter than a step may be met by one march only.
      constexpr double kFloatMm = 1e-3;
      const bool agree = (alone.value_or(0.0) > 0.0) == (depth_mm > 0.0F) &&
                         (depth_mm == 0.0F || std::abs(*alone * in_cam.z() - depth_mm) < kFloatMm);
      if (!agree) ++different;
    }
  }
  EXPECT_EQ(hits, picture.hit_pixels);
  EXPECT_LE(different, picture.width_px * picture.height_px / 200) << "of all pixels";
}

TEST(ViewHull, BeamsDontChangeThePicture) {
  Random random(4005);
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    for (int trial = 0; trial < 5; ++trial) {
      const RandomScene scene = MakeRingScene(&random, random.Whole(2, 5), unseen);
      const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
      // 8 n + 1 pixels a side: the last tile is a single pixel.
      ExpectEqualsSingleRays(hull, ViewCamera(73, 49, 700.0 * random.Direction(), Vector3d::Zero()), 0.05);
      // From inside the workspace, and possibly inside the hull.
      ExpectEqualsSingleRays(hull, ViewCamera(40, 33, 60.0 * random.Direction(), 20.0 * random.Direction()),
                             0.05);
    }
  }
}

TEST(ViewHull, SeenFromARigCameraItIsNoLargerThanTheSilhouette) {
  Random random(4006);
  for (int trial = 0; trial < 4; ++trial) {
    const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kOutside);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    const core::CameraModel& view = scene.rig->cameras[0];
    const HullView picture = ViewHull(hull, view);
    for (int y = 0; y < picture.height_px; ++y) {
      for (int x = 0; x < picture.width_px; ++x) {
        const bool hit = picture.depth_mm[static_cast<std::size_t>(y * picture.width_px + x)] > 0.0F;
        EXPECT_TRUE(!hit || scene.masks[0].At(x, y));
      }
    }
    EXPECT_GT(picture.hit_pixels, 0);
    ExpectEqualsSingleRays(hull, view, 0.25);
  }
}

TEST(ViewHull, OneThreadPaintsWhatTwoPaint) {
  Random random(4007);
  const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const core::CameraModel view = ViewCamera(200, 150, Vector3d(500, 300, 400), Vector3d::Zero());
  const HullView two = ViewHull(hull, view);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const HullView one = ViewHull(hull, view);
  EXPECT_EQ(one.depth_mm, two.depth_mm);
  EXPECT_EQ(one.normal_in_world, two.normal_in_world);
  EXPECT_EQ(one.probes, two.probes);
  EXPECT_EQ(one.skipped_pixels, two.skipped_pixels);
}

TEST(ViewHull, EmptyAndFullMasks) {
  Random random(4008);
  RandomScene scene = MakeRingScene(&random, 2, core::UnseenPolicy::kAbstain);
  const core::CameraModel view = ViewCamera(80, 60, Vector3d(0, -600, 0), Vector3d::Zero());
  for (core::BitMask& mask : scene.masks) mask = core::BitMask(160, 120);
  EXPECT_EQ(ViewHull(MakeVisualHull(scene.rig, scene.masks), view).hit_pixels, 0);
  for (core::BitMask& mask : scene.masks) {
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) mask.Set(x, y, true);
    }
  }
  // All object, seen by both: the hull is the workspace where it is seen, and its front face fills the
  // picture's middle at the depth of that face.
  const HullView full = ViewHull(MakeVisualHull(scene.rig, scene.masks), view);
  constexpr float kFaceDepthMm = 460.0F;  // the face y = -140 from y = -600
  EXPECT_NEAR(full.depth_mm[30 * 80 + 40], kFaceDepthMm, 1e-2F);
}

TEST(ViewHull, NormalsOfABallSeenByManyCamerasPointAwayFromIt) {
  // Silhouettes of a ball from 24 cameras: the hull is nearly the ball, its normals nearly radial.
  constexpr double kBallRadiusMm = 60.0;
  core::Rig rig;
  rig.workspace_mm = {Vector3d::Constant(-100), Vector3d::Constant(100)};
  std::vector<core::BitMask> masks;
  Random random(4009);
  for (int i = 0; i < 24; ++i) {
    core::CameraCalibration c;
    c.image_width_px = c.image_height_px = 240;
    c.camera_matrix << 700.0, 0.0, 119.5, 0.0, 700.0, 119.5, 0.0, 0.0, 1.0;
    c.cam_from_world = core::CamFromWorldLookingAt(600.0 * random.Direction(), Vector3d::Zero());
    rig.cameras.emplace_back(c);
    core::BitMask mask(240, 240);
    const double apparent = std::tan(std::asin(kBallRadiusMm / 600.0)) * 700.0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 240; ++x) mask.Set(x, y, std::hypot(x - 119.5, y - 119.5) <= apparent);
    }
    masks.push_back(mask);
  }
  const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), masks);
  const core::CameraModel view = ViewCamera(96, 96, Vector3d(400, 100, 200), Vector3d::Zero());
  const HullView picture = ViewHull(hull, view);
  ASSERT_GT(picture.hit_pixels, 500);
  double sum = 0.0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const auto pixel = static_cast<std::size_t>(y * 96 + x);
      if (picture.depth_mm[pixel] == 0.0F) continue;
      const Vector3d in_cam = picture.depth_mm[pixel] * view.NormalisedFromPixel({x, y})->homogeneous();
      const Vector3d hit = view.cam_from_world().Inverse() * in_cam;
      sum += hit.normalized().dot(picture.normal_in_world[pixel].cast<double>());
    }
  }
  // The hull of 24 views is faceted by about 15 degrees and the picture's edges are staircases.
  constexpr double kMeanCosine = 0.95;
  EXPECT_GT(sum / static_cast<double>(picture.hit_pixels), kMeanCosine);
}

}  // namespace
}  // namespace elbowroom::recon
