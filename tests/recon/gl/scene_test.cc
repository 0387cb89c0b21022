#include "recon/gl/scene/scene.h"

#include <gtest/gtest.h>

#include "core/camera_model.h"

namespace elbowroom::recon::gl {
namespace {

constexpr double kRoundingPx = 1e-6;

core::CameraModel WideCamera() {
  core::CameraCalibration calibration;
  calibration.name = "wide";
  calibration.image_width_px = 640;
  calibration.image_height_px = 480;
  calibration.camera_matrix << 420, 0, 315, 0, 415, 244, 0, 0, 1;
  calibration.distortion_coefficients = {-0.21, 0.05, 0.001, -0.002};
  calibration.cam_from_world = core::CamFromWorldLookingAt({900, -700, 800}, {0, 0, 100});
  return core::CameraModel(calibration);
}

TEST(FrustumOf, CornersFallOnThePicturesCorners) {
  const core::CameraModel camera = WideCamera();
  const auto frustum = FrustumOf(camera, 150.0);
  ASSERT_TRUE(frustum);
  EXPECT_LT((frustum->center_in_world - Eigen::Vector3d(900, -700, 800)).norm(), 1e-9);
  const std::array<Eigen::Vector2d, 4> expected_px{Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(639.5, -0.5),
                                                   Eigen::Vector2d(639.5, 479.5),
                                                   Eigen::Vector2d(-0.5, 479.5)};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR((camera.cam_from_world() * frustum->corners_in_world[i]).z(), 150.0, 1e-9);
    const auto pixel = camera.Project(frustum->corners_in_world[i]);
    ASSERT_TRUE(pixel) << i;
    EXPECT_LT((*pixel - expected_px[i]).norm(), kRoundingPx) << i;
  }
}

}  // namespace
}  // namespace elbowroom::recon::gl
