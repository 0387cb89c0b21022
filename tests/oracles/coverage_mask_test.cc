#include "tests/oracles/coverage_mask.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "recon/synthetic/rig_presets.h"
#include "tests/oracles/picture_labels.h"

namespace elbowroom::oracles {
namespace {

constexpr double kFocalPx = 1000.0;
constexpr double kDistanceMm = 1000.0;

core::CameraModel FrontCamera() {
  core::CameraCalibration c;
  c.name = "front";
  c.image_width_px = c.image_height_px = 120;
  c.camera_matrix << kFocalPx, 0.0, 60.3, 0.0, kFocalPx, 59.8, 0.0, 0.0, 1.0;
  c.distortion_coefficients = {0, 0, 0, 0, 0};
  c.cam_from_world = core::CamFromWorldLookingAt({0.0, -kDistanceMm, 0.0}, {0.0, 0.0, 0.0});
  return core::CameraModel(std::move(c));
}

// How far the boundary of a ball's mask may stand off the ball's contour.
void ExpectContourOfBall(double footprint_px, double tolerance_px) {
  constexpr double kRadiusMm = 30.0;
  const core::CameraModel camera = FrontCamera();
  const std::array solids{recon::Solid{recon::Sphere{kRadiusMm}, {}, Eigen::Vector3d::Constant(200.0)}};
  const core::SoftMask mask = CoverageMask(camera, solids, footprint_px);
  ASSERT_NO_THROW(mask.Validate());
  // The contour of a ball on the principal axis is a circle.
  const double rim_px = kFocalPx * kRadiusMm / std::sqrt(kDistanceMm * kDistanceMm - kRadiusMm * kRadiusMm);
  const PictureLabels labels(mask, BoundaryConvention::kMarchingSquares, false);
  for (double angle_rad = 0.0; angle_rad < 2.0 * std::numbers::pi; angle_rad += 0.01) {
    const Vector2L direction(std::cos(angle_rad), std::sin(angle_rad)), center(60.3L, 59.8L);
    EXPECT_TRUE(labels.IsObject(center + (rim_px - tolerance_px) * direction)) << angle_rad;
    EXPECT_FALSE(labels.IsObject(center + (rim_px + tolerance_px) * direction)) << angle_rad;
  }
}

TEST(CoverageMask, OfABallHasItsBoundaryOnTheBallsContour) {
  constexpr double kOwnSquarePx = 0.11;  // 0.086 px where a pixel is not touched by the edge, and counting
  constexpr double kTwoPixelsPx = 0.06;  // counting, and the circle's curve over two pixels
  ExpectContourOfBall(1.0, kOwnSquarePx);
  ExpectContourOfBall(2.0, kTwoPixelsPx);
}

TEST(CoverageMask, AgreesWithTheCentreMaskButForPixelsOnTheContour) {
  const auto solids =
      std::array{recon::Solid{recon::Box{{20.0, 20.0, 40.0}}, {}, Eigen::Vector3d::Constant(9.0)}};
  const core::BitMask centers = CenterMask(FrontCamera(), solids);
  const core::SoftMask coverage = CoverageMask(FrontCamera(), solids);
  const core::BitMask boundary = core::BoundaryPixels(centers);
  int differing = 0;
  for (int y = 0; y < centers.height_px(); ++y) {
    for (int x = 0; x < centers.width_px(); ++x) {
      if (centers.At(x, y) == coverage.mask.At(x, y)) continue;
      ++differing;
      EXPECT_TRUE(boundary.At(x, y)) << x << ' ' << y;
    }
  }
  EXPECT_LT(differing, 10);
}

}  // namespace
}  // namespace elbowroom::oracles
