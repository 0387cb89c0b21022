// What each eye sees, against the projection worked out by hand.
#include "app/control/participant/eye_views.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/error.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

core::RigidTransform SomeHead() {
  return {Eigen::AngleAxisd(0.7, Vector3d(0.2, -0.4, 0.9).normalized()).toRotationMatrix(),
          {100.0, -600.0, 400.0}};
}

// Where a point of the head's frame is in an eye's picture, by the frustum whose axis goes through the point
// straight ahead at convergence_mm.
Vector2d ByHand(const Vector3d& x_in_head, double eye_x_mm, const EyeOptions& options, int width_px,
                int height_px) {
  const double focal_px = 0.5 * height_px / std::tan(0.5 * options.vertical_fov_rad);
  const Vector2d shear(-eye_x_mm / options.convergence_mm, 0.0);
  const Vector2d ray = Vector2d(x_in_head.x() - eye_x_mm, x_in_head.y()) / x_in_head.z() - shear;
  return focal_px * ray + 0.5 * Vector2d(width_px - 1, height_px - 1);
}

TEST(EyeViews, StereoIsTwoOffAxisFrustums) {
  constexpr double kHalfColumnPx = 0.2501;  // the cut is a whole number of columns, shared by both sides
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    EyeOptions options{ViewMode::kStereo, 63.0 + 20.0 * any(random), 1.1 + 0.5 * any(random),
                       700.0 + 300.0 * any(random)};
    const auto eyes = EyeViewsOf(SomeHead(), options, 1200, 500);
    ASSERT_EQ(eyes.size(), 2U);
    const Vector3d x_in_head(200.0 * any(random), 200.0 * any(random), 800.0 + 300.0 * any(random));
    for (const double side : {-1.0, 1.0}) {
      const EyeView& eye = eyes[side < 0.0 ? 0 : 1];
      EXPECT_EQ(eye.width_px, 600);
      EXPECT_LE(eye.first_column + eye.width_px, eye.view.width_px);
      eye.view.Validate();
      const auto pixel = eye.view.Project(SomeHead() * x_in_head);
      ASSERT_TRUE(pixel.has_value());
      const Vector2d in_picture = *pixel - Vector2d(eye.first_column, 0.0);
      const Vector2d expected = ByHand(x_in_head, side * 0.5 * options.ipd_mm, options, 600, 500);
      EXPECT_NEAR(in_picture.x(), expected.x(), kHalfColumnPx);
      EXPECT_NEAR(in_picture.y(), expected.y(), 1e-6);
    }
  }
}

// The left eye sees what is near further to the right than the right eye does.
TEST(EyeViews, HaveTheRightSign) {
  const auto eyes = EyeViewsOf({}, {ViewMode::kStereo, 64.0, 1.0, 700.0}, 1200, 500);
  const auto at = [&](const EyeView& eye, double depth_mm) {
    return (*eye.view.Project({0.0, 0.0, depth_mm})).x() - eye.first_column;
  };
  EXPECT_GT(at(eyes[0], 300.0), at(eyes[1], 300.0) + 20.0);
  EXPECT_LT(at(eyes[0], 3000.0), at(eyes[1], 3000.0) - 20.0);
  EXPECT_NEAR(at(eyes[0], 700.0), at(eyes[1], 700.0), 0.51);
}

TEST(EyeViews, MonoIsTheHeadsOwnView) {
  for (const ViewMode mode : {ViewMode::kMono, ViewMode::kMirror}) {
    const auto eyes = EyeViewsOf(SomeHead(), {mode, 63.0, 1.0, 700.0}, 640, 480);
    ASSERT_EQ(eyes.size(), 1U);
    EXPECT_EQ(eyes[0].width_px, 640);
    EXPECT_LT((eyes[0].view.EyeInWorld() - SomeHead().translation_mm).norm(), 1e-9);
    EXPECT_LT((*eyes[0].view.Project(SomeHead() * Vector3d(0.0, 0.0, 500.0)) - Vector2d(319.5, 239.5)).norm(),
              1e-9);
    EXPECT_GT((*eyes[0].view.Project(SomeHead() * Vector3d(50.0, 0.0, 500.0))).x(), 320.0);
  }
}

// What a headset asks for, but for half a pixel at each side; and what is said to be in the pictures is in
// them.
TEST(EyeViews, AHeadsetsEyesAreCutOutOfSymmetricPictures) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    recon::HeadsetEyes eyes;
    for (std::size_t side = 0; side < 2; ++side) {
      eyes.eyes[side].head_from_eye = {
          Eigen::AngleAxisd(0.1 * any(random), Vector3d(any(random), 1.0, any(random)).normalized())
              .toRotationMatrix(),
          {side == 0 ? -32.0 : 32.0, any(random), any(random)}};
      eyes.eyes[side].tangents = {-0.9 + 0.5 * any(random), 0.9 + 0.5 * any(random), 0.9 + 0.4 * any(random),
                                  -0.9 + 0.4 * any(random)};
    }
    const auto views = HeadsetEyeViewsOf(SomeHead(), eyes, 500, 520);
    ASSERT_EQ(views.size(), 2U);
    for (std::size_t side = 0; side < 2; ++side) {
      const EyeView& eye = views[side];
      eye.view.Validate();
      ASSERT_GE(eye.first_column, 0);
      ASSERT_GE(eye.first_row, 0);
      ASSERT_LE(eye.first_column + eye.width_px, eye.view.width_px);
      ASSERT_LE(eye.first_row + eye.height_px, eye.view.height_px);
      EXPECT_LE(eye.width_px, 500);
      EXPECT_LE(eye.height_px, 520);
      const recon::EyeTangents& wanted = eyes.eyes[side].tangents;
      const recon::EyeTangents seen = eye.Seen();
      const double pixel = 1.0 / eye.view.focal_px;
      EXPECT_NEAR(seen.left, wanted.left, 0.501 * pixel);
      EXPECT_NEAR(seen.right, wanted.right, 1.01 * pixel);  // half of it where the picture would be too wide
      EXPECT_NEAR(seen.up, wanted.up, 0.501 * pixel);
      EXPECT_NEAR(seen.down, wanted.down, 1.01 * pixel);
      // A ray of the eye is in the part where the tangents say.
      const double x = seen.left + (seen.right - seen.left) * (0.5 + 0.49 * any(random));
      const double y = seen.down + (seen.up - seen.down) * (0.5 + 0.49 * any(random));
      const Vector3d in_world =
          SomeHead() * (eyes.eyes[side].head_from_eye * Vector3d(900.0 * x, -900.0 * y, 900.0));
      const auto at = eye.view.Project(in_world);
      ASSERT_TRUE(at.has_value());
      EXPECT_NEAR(at->x() - eye.first_column + 0.5, (x - seen.left) / pixel, 1e-6);
      EXPECT_NEAR(at->y() - eye.first_row + 0.5, (seen.up - y) / pixel, 1e-6);
    }
  }
}

TEST(EyeViews, RefuseWhatIsOutOfRange) {
  EXPECT_THROW((void)EyeViewsOf({}, {ViewMode::kMono, -1.0, 1.0, 700.0}, 640, 480), core::PreconditionError);
  EXPECT_THROW((void)EyeViewsOf({}, {ViewMode::kMono, 60.0, 3.1, 700.0}, 640, 480), core::PreconditionError);
  EXPECT_THROW((void)EyeViewsOf({}, {ViewMode::kMono, 60.0, 1.0, 0.0}, 640, 480), core::PreconditionError);
  EXPECT_THROW((void)EyeViewsOf({}, {}, 10, 480), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::control
