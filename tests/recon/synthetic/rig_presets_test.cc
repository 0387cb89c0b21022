// The preset rigs are where they claim to be and see what they must.
#include "recon/synthetic/rig_presets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace elbowroom::core {

void PrintTo(const Rig& rig, std::ostream* out) { *out << rig.name; }

}  // namespace elbowroom::core

namespace elbowroom::recon {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// Length in the world of one pixel at the image's middle, `distance_mm` along the optical axis.
Eigen::Vector2d PixelFootprintMm(const core::CameraModel& camera, double distance_mm) {
  const Eigen::Vector2d middle(0.5 * (camera.width_px() - 1), 0.5 * (camera.height_px() - 1));
  const Eigen::Vector2d here = camera.NormalisedFromPixel(middle).value();
  const Eigen::Vector2d aside = camera.NormalisedFromPixel(middle + Eigen::Vector2d(1.0, 1.0)).value();
  return (aside - here) * distance_mm;
}

double FarthestCornerMm(const core::CameraModel& camera, const AlignedBox3d& box) {
  double farthest_mm = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d x_in_world = box.corner(static_cast<AlignedBox3d::CornerType>(corner));
    farthest_mm = std::max(farthest_mm, (x_in_world - camera.center_in_world()).norm());
  }
  return farthest_mm;
}

TEST(PaperRig, ReproducesThePapersDistanceAndPixelFootprint) {
  const core::Rig rig = PaperRig();
  ASSERT_EQ(rig.cameras.size(), 3U);
  double farthest_mm = 0.0;
  for (const core::CameraModel& camera : rig.cameras) {
    EXPECT_EQ(camera.width_px(), 720);
    EXPECT_EQ(camera.height_px(), 243);
    const Eigen::Vector2d footprint_mm = PixelFootprintMm(camera, 3300.0);
    EXPECT_NEAR(footprint_mm.x(), 2.5, 0.05) << "the paper gives one decimal of a millimetre";
    EXPECT_NEAR(footprint_mm.y(), 5.8, 0.05);
    farthest_mm = std::max(farthest_mm, FarthestCornerMm(camera, rig.workspace_mm));
  }
  EXPECT_NEAR(farthest_mm, 3300.0, 1.0);
  const Vector3d size_mm = rig.workspace_mm.sizes();
  constexpr double kFootMm = 304.8;
  EXPECT_NEAR(size_mm.x(), 5.0 * kFootMm, 1.0);
  EXPECT_NEAR(size_mm.y(), 4.0 * kFootMm, 1.0);
  EXPECT_NEAR(size_mm.z(), 3.0 * kFootMm, 1.0);
}

TEST(PaperRig, ItsCamerasHangOverheadAtTheLeftAndOnADiagonal) {
  const core::Rig rig = PaperRig();
  EXPECT_LT(rig.cameras[0].center_in_world().head<2>().norm(), 1.0);
  EXPECT_GT(rig.cameras[0].center_in_world().z(), rig.workspace_mm.max().z());
  EXPECT_LT(rig.cameras[1].center_in_world().x(), rig.workspace_mm.min().x());
  EXPECT_NEAR(rig.cameras[1].center_in_world().y(), 0.0, 1.0);
  EXPECT_NEAR(rig.cameras[2].center_in_world().z(), 914.0, 1.0) << "three feet above the table";
}

class ModernRigs : public testing::TestWithParam<core::Rig> {};

TEST_P(ModernRigs, EveryCameraSeesTheTasksSpaceThroughADistortedLens) {
  const core::Rig rig = GetParam();
  const AlignedBox3d task_mm(Vector3d(-100.0, -160.0, 20.0), Vector3d(260.0, 160.0, 360.0));
  for (const core::CameraModel& camera : rig.cameras) {
    for (int corner = 0; corner < 8; ++corner) {
      const auto pixel = camera.Project(task_mm.corner(static_cast<AlignedBox3d::CornerType>(corner)));
      ASSERT_TRUE(pixel) << camera.name();
      EXPECT_TRUE(pixel->x() >= 0.0 && pixel->x() <= camera.width_px() - 1) << camera.name();
      EXPECT_TRUE(pixel->y() >= 0.0 && pixel->y() <= camera.height_px() - 1) << camera.name();
    }
    // The picture's corner is displaced by several pixels: the distortion matters.
    const Eigen::Vector2d normalised = camera.NormalisedFromPixel({0.0, 0.0}).value();
    const Eigen::Matrix3d& k = camera.calibration().camera_matrix;
    const Eigen::Vector2d pinhole(k(0, 0) * normalised.x() + k(0, 2), k(1, 1) * normalised.y() + k(1, 2));
    EXPECT_GT(pinhole.norm(), 3.0) << camera.name();
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, ModernRigs, testing::Values(FourCameraRig(), EightCameraRig()),
                         [](const auto& preset) { return preset.param.name; });

TEST(ModernRigPresets, HaveTheSizesThatTheyAreNamedAfter) {
  const core::Rig four = FourCameraRig();
  const core::Rig eight = EightCameraRig();
  ASSERT_EQ(four.cameras.size(), 4U);
  ASSERT_EQ(eight.cameras.size(), 8U);
  EXPECT_EQ(four.cameras[0].width_px(), 640);
  EXPECT_EQ(eight.cameras[0].height_px(), 720);
}

}  // namespace
}  // namespace elbowroom::recon
