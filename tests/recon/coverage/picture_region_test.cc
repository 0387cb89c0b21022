// The polygon of a picture's border against the lens itself.
#include "recon/coverage/picture_region.h"

#include <gtest/gtest.h>

#include <optional>

#include "recon/calibration/rig_uncertainty.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// How far the pixel is from the picture's border.
double FromBorderPx(const core::CameraModel& camera, const Eigen::Vector2d& pixel) {
  const auto from = [](double at, double size) {
    return std::min(std::abs(at + 0.5), std::abs(at - size + 0.5));
  };
  return std::min(from(pixel.x(), camera.width_px()), from(pixel.y(), camera.height_px()));
}

core::CameraModel OrdinaryCamera(Random* random) {
  core::CameraCalibration camera;
  camera.name = "cam";
  camera.image_width_px = random->Whole(300, 800), camera.image_height_px = random->Whole(300, 800);
  const double focal_px = random->Uniform(350.0, 1200.0);
  camera.camera_matrix << focal_px, 0.0, 0.5 * camera.image_width_px, 0.0,
      focal_px * random->Uniform(0.9, 1.1), 0.5 * camera.image_height_px, 0.0, 0.0, 1.0;
  camera.distortion_coefficients = {random->Uniform(-0.37, 0.1), random->Uniform(0.0, 0.1),
                                    random->Uniform(-1e-3, 1e-3), random->Uniform(-1e-3, 1e-3)};
  if (random->Chance(0.2)) camera.distortion_coefficients = {0.0, 0.0, 0.0, 0.0};
  camera.cam_from_world = {random->Rotation(), Vector3d(10.0, -20.0, 30.0)};
  return core::CameraModel(camera);
}

TEST(PictureRegion, HoldsWhatTheLensPutsIntoThePicture) {
  constexpr double kBorderPx = 2.0;  // what picture_region.h states
  Random random(1);
  int inside = 0, outside = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const core::CameraModel camera = OrdinaryCamera(&random);
    const PictureRegion region(camera);
    for (int i = 0; i < 2000; ++i) {
      const Vector3d x_in_cam = random.Uniform(0.1, 1000.0) * random.Direction();
      const std::optional<Eigen::Vector2d> pixel = camera.ProjectInCam(x_in_cam);
      if (pixel && FromBorderPx(camera, *pixel) < kBorderPx) continue;
      const bool truth = IsInPicture(camera, camera.cam_from_world().Inverse() * x_in_cam);
      EXPECT_EQ(region.Holds(x_in_cam), truth) << trial << ": " << x_in_cam.transpose();
      (truth ? inside : outside) += 1;
    }
  }
  EXPECT_GT(inside, 5000);
  EXPECT_GT(outside, 5000);
}

TEST(PictureRegion, CutsARayWhereItEntersAndLeaves) {
  constexpr int kSteps = 400;
  Random random(2);
  int cut = 0;
  for (int trial = 0; trial < 200; ++trial) {
    // Odd lenses of small pictures, too: the polygon itself is what is cut.
    const core::CameraModel camera =
        trial % 2 == 0 ? OrdinaryCamera(&random)
                       : RandomCamera(&random, static_cast<LensKind>(trial / 2 % kLensKinds));
    const PictureRegion region(camera);
    const RayInCam ray{300.0 * random.Direction() + Vector3d(0.0, 0.0, 400.0), random.Direction()};
    RayStretches seen;
    const Stretch within{random.Uniform(0.0, 200.0), random.Uniform(300.0, 1500.0)};
    region.Cut(ray, within, &seen);
    int wrong = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double t = within.begin + (within.end - within.begin) * (i + 0.5) / kSteps;
      bool is_in = false;
      for (const Stretch& stretch : seen.all()) is_in = is_in || (t > stretch.begin && t < stretch.end);
      wrong += is_in == region.Holds(ray.At(t)) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0) << trial;
    cut += seen.is_empty() ? 0 : 1;
  }
  EXPECT_GT(cut, 40);
}

TEST(PictureRegion, ABallThatItSurelyHoldsIsInThePicture) {
  Random random(3);
  int held = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const core::CameraModel camera = OrdinaryCamera(&random);
    const PictureRegion region(camera);
    const Vector3d center = random.Uniform(200.0, 1000.0) * (Vector3d(0, 0, 1) + 0.5 * random.Direction());
    const double radius_mm = random.Uniform(1.0, 80.0);
    if (!region.SurelyHoldsBall(center, radius_mm)) continue;
    ++held;
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(region.Holds(center + radius_mm * random.Direction()));
  }
  EXPECT_GT(held, 200);
}

TEST(RayStretches, KeepAndRemove) {
  RayStretches stretches, others;
  stretches.Append({1.0, 5.0});
  stretches.Append({5.0, 6.0});
  EXPECT_EQ(stretches.all().size(), 1U);
  stretches.Remove({2.0, 3.0});
  ASSERT_EQ(stretches.all().size(), 2U);
  others.Append({0.0, 1.5});
  others.Append({2.5, 4.0});
  stretches.Keep(others);
  ASSERT_EQ(stretches.all().size(), 2U);
  EXPECT_DOUBLE_EQ(stretches.all()[0].end, 1.5);
  EXPECT_DOUBLE_EQ(stretches.all()[1].begin, 3.0);
  EXPECT_DOUBLE_EQ(stretches.VolumePerSteradian(), (1.5 * 1.5 * 1.5 - 1.0) / 3.0 + (64.0 - 27.0) / 3.0);
  EXPECT_DOUBLE_EQ(stretches.VolumePerSteradian({3.5, 9.0}), (64.0 - 3.5 * 3.5 * 3.5) / 3.0);
  stretches.Remove({0.0, 10.0});
  EXPECT_TRUE(stretches.is_empty());
}

}  // namespace
}  // namespace elbowroom::recon
