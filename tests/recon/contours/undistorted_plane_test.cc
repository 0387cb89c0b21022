#include "recon/contours/undistorted_plane.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "recon/contours/contour_map.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// What picture_plane.h promises, in units of the plane.
constexpr double kPromisedError = 1e-5;
// A domain's rim is known to the inversion's 1e-9; positions this near to it may fall on either side.
constexpr double kRim = 1e-6;

core::CameraModel LensCamera(int width_px, int height_px, std::vector<double> coefficients,
                             core::DistortionModel model = core::DistortionModel::kPlumbBob) {
  core::CameraCalibration c;
  c.name = "camera";
  c.image_width_px = width_px, c.image_height_px = height_px;
  c.camera_matrix << 0.8 * width_px, 0.0, 0.48 * width_px, 0.0, 0.8 * width_px, 0.52 * height_px, 0.0, 0.0,
      1.0;
  c.distortion_model = model;
  c.distortion_coefficients = std::move(coefficients);
  return core::CameraModel(c);
}

void ExpectFollowsTheLens(const UndistortedPlane& plane, const Vector2d& pixel) {
  const std::optional<Vector2d> found = plane.FromPixel(pixel);
  const std::optional<Vector2d> exact = plane.camera().NormalisedFromPixel(pixel);
  if (!found || !exact) {
    if (found && plane.camera().is_ideal()) return;  // a pinhole needs no domain
    const Vector2d at = exact ? *exact : found ? Vector2d(*found / plane.focal_px()) : Vector2d::Zero();
    if (found.has_value() != exact.has_value()) {
      EXPECT_NEAR(at.norm(), plane.camera().max_radius(), kRim * at.norm()) << pixel.transpose();
    }
    return;
  }
  EXPECT_LE((*found - plane.focal_px() * *exact).norm(), kPromisedError) << pixel.transpose();
}

TEST(UndistortedPlane, FollowsEveryKindOfLens) {
  Random random(5001);
  for (int trial = 0; trial < 300; ++trial) {
    const core::CameraModel camera = RandomCamera(&random, static_cast<LensKind>(trial % kLensKinds));
    const UndistortedPlane plane(camera);
    const Vector2d size(camera.width_px(), camera.height_px());
    for (int i = 0; i < 300; ++i) {
      Vector2d pixel = size.cwiseProduct(Vector2d(random.Uniform(0, 1), random.Uniform(0, 1))).array() - 0.5;
      // The picture's own border now and then, and its corners.
      if (random.Chance(0.2)) pixel.x() = random.Chance(0.5) ? -0.5 : size.x() - 0.5;
      if (random.Chance(0.2)) pixel.y() = random.Chance(0.5) ? -0.5 : size.y() - 0.5;
      ExpectFollowsTheLens(plane, pixel);
    }
    if (HasFailure()) FAIL() << "lens kind " << trial % kLensKinds << ", trial " << trial;
  }
}

TEST(UndistortedPlane, FollowsTheLensOfALargePicture) {
  Random random(5002);
  for (const auto& coefficients : {std::vector<double>{-0.37, 0.17, 1e-3, -1e-3, -0.04},
                                   std::vector<double>{0.1, -0.2, 0.0, 0.0, 0.1}}) {
    const UndistortedPlane plane(LensCamera(644, 486, coefficients));
    for (int i = 0; i < 3000; ++i)
      ExpectFollowsTheLens(plane, {random.Uniform(-0.5, 643.5), random.Uniform(-0.5, 485.5)});
  }
}

TEST(UndistortedPlane, TakesManyPixelsToTheSameBitsAsOneOnEveryProcessor) {
  Random random(5003);
  const auto bits = [](const Vector2d& at) {
    return std::array{std::bit_cast<std::uint64_t>(at.x()), std::bit_cast<std::uint64_t>(at.y())};
  };
  int targets = 0, seen = 0, unseen = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const core::CameraModel camera = RandomCamera(&random, static_cast<LensKind>(trial % kLensKinds));
    const UndistortedPlane plane(camera);
    std::vector<Vector2d> pixels(static_cast<std::size_t>(random.Whole(0, 200)));
    for (Vector2d& pixel : pixels)
      pixel = {random.Uniform(-0.5, camera.width_px() - 0.5), random.Uniform(-0.5, camera.height_px() - 0.5)};
    std::vector<Vector2d> expected;
    for (const Vector2d& pixel : pixels) {
      const std::optional<Vector2d> at = plane.FromPixel(pixel);
      (at ? seen : unseen) += 1;
      expected.push_back(at.value_or(Vector2d::Constant(std::numeric_limits<double>::quiet_NaN())));
    }
    targets = 0;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1, ++targets) {
      hwy::SetSupportedTargetsForTest(left & -left);
      std::vector<Vector2d> positions(pixels.size());
      plane.FromPixels(pixels, positions.data());
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (std::isnan(expected[i].x())) {
          EXPECT_TRUE(std::isnan(positions[i].x())) << pixels[i].transpose();
        } else {
          EXPECT_EQ(bits(positions[i]), bits(expected[i])) << pixels[i].transpose();
        }
      }
    }
    hwy::SetSupportedTargetsForTest(0);
  }
  EXPECT_GE(targets, 2) << "the portable one and this processor's";
  EXPECT_GT(seen, 1000);
  EXPECT_GT(unseen, 10) << "pixels without a ray";
}

TEST(UndistortedPlane, IsAPinholesOwnPlane) {
  core::CameraCalibration c;
  c.image_width_px = 10, c.image_height_px = 8;
  c.camera_matrix << 100.0, 20.0, 4.0, 0.0, 50.0, 3.0, 0.0, 0.0, 1.0;
  const UndistortedPlane plane{core::CameraModel(c)};
  EXPECT_EQ(plane.focal_px(), 100.0) << "the finer side is one unit";
  EXPECT_TRUE(plane.FromPixel({4.0, 3.0})->isZero(1e-15));
  // (x, y) = (4 + 100 X + 20 Y, 3 + 50 Y)
  constexpr double kRounding = 1e-12;
  EXPECT_TRUE(plane.FromPixel({4.0 + 10.0 + 6.0, 3.0 + 15.0})->isApprox(Vector2d(10.0, 30.0), kRounding));
  EXPECT_FALSE(plane.unseen_pixels().has_value());
}

TEST(UndistortedPlane, KnowsThePixelsThatAFoldingLensDoesNotSee) {
  // R(r) = r - 0.9 r^3 turns back at r = 0.61, where it is 0.41: the corners, at 0.75, have no ray.
  const core::CameraModel camera = LensCamera(64, 48, {-0.9, 0.0, 0.0, 0.0});
  const UndistortedPlane plane(camera);
  ASSERT_TRUE(plane.unseen_pixels().has_value());
  int unseen = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool is_seen = camera.NormalisedFromPixel({x, y}).has_value();
      EXPECT_EQ(plane.unseen_pixels()->At(x, y), !is_seen) << x << ' ' << y;
      EXPECT_EQ(plane.FromPixel({x, y}).has_value(), is_seen);
      unseen += is_seen ? 0 : 1;
      if (is_seen) ExpectFollowsTheLens(plane, {x, y});
    }
  }
  EXPECT_TRUE(plane.unseen_pixels()->At(0, 0));
  EXPECT_GT(unseen, 200);
  EXPECT_LT(unseen, 2500);
}

TEST(UndistortedPlane, TakesPicturesOfOnePixel) {
  for (const std::vector<double>& coefficients : {std::vector<double>{}, {-0.2, 0.1, 0.0, 0.0}}) {
    const UndistortedPlane plane(LensCamera(1, 1, coefficients));
    for (const double x : {-0.5, 0.0, 0.5})
      for (const double y : {-0.5, 0.0, 0.5}) ExpectFollowsTheLens(plane, {x, y});
  }
}

TEST(UndistortedPlane, OutlineIsThePictureAndIsMadeOnce) {
  const UndistortedPlane plane(LensCamera(40, 30, {-0.2, 0.05, 0.0, 0.0}));
  const ContourMap& outline = plane.outline();
  EXPECT_EQ(&outline, &plane.outline());
  EXPECT_FALSE(outline.exterior_is_object());
  for (int y = -2; y < 32; ++y) {
    for (int x = -2; x < 42; ++x) {
      const bool is_within = x >= 0 && y >= 0 && x < 40 && y < 30;
      const std::optional<Vector2d> normalised = plane.camera().NormalisedFromPixel({x, y});
      if (!normalised) continue;
      EXPECT_EQ(outline.IsObject(plane.focal_px() * *normalised), is_within) << x << ' ' << y;
    }
  }
}

TEST(UndistortedPlane, OneACameraInTheRigsOrder) {
  Random random(5003);
  const RandomScene scene = MakeRandomScene(&random);
  const UndistortedPlanes planes = MakeUndistortedPlanes(*scene.rig);
  ASSERT_EQ(planes.size(), scene.rig->cameras.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_EQ(planes[i]->camera().width_px(), scene.rig->cameras[i].width_px());
    EXPECT_EQ(planes[i]->camera().calibration().camera_matrix,
              scene.rig->cameras[i].calibration().camera_matrix);
  }
}

}  // namespace
}  // namespace elbowroom::recon
