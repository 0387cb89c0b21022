#include "tests/accuracy/depth_error.h"

#include <gtest/gtest.h>

#include <array>

#include "recon/synthetic/solids.h"
#include "tests/accuracy/disturbed_rig.h"
#include "tests/accuracy/drawn_mesh.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kFloatMm = 2e-4;  // depth maps are 32-bit floats, at 1 m

core::CameraModel View() {
  core::CameraCalibration c;
  c.name = "view";
  c.image_width_px = 200;
  c.image_height_px = 160;
  c.camera_matrix << 600.0, 0.0, 99.5, 0.0, 600.0, 79.5, 0.0, 0.0, 1.0;
  c.distortion_coefficients = {0, 0, 0, 0, 0};
  c.cam_from_world = core::CamFromWorldLookingAt({0.0, -1000.0, 0.0}, Vector3d::Zero());
  return core::CameraModel(std::move(c));
}

SurfacePicture Picture(const recon::Solid& solid) {
  const std::array solids{solid};
  return {View(), PictureOf(View(), [&](const recon::Ray& ray) { return NearestHitMm(solids, ray); })};
}

recon::Solid Ball(double radius_mm) { return {recon::Sphere{radius_mm}, {}, Vector3d::Constant(200.0)}; }
recon::Solid Wall(double front_mm) {
  recon::Solid wall{recon::Box{{2000.0, 100.0, 2000.0}}, {}, Vector3d::Constant(200.0)};
  wall.world_from_solid.translation_mm.y() = 50.0 - front_mm;
  return wall;
}

DepthError Compare(const SurfacePicture& reference, const SurfacePicture& found) {
  ErrorTally tally;
  tally.Add(reference, found.depth());
  return tally.Summary();
}

TEST(DepthErrorOf, APictureWithItselfIsNothing) {
  const DepthError error = Compare(Picture(Ball(80.0)), Picture(Ball(80.0)));
  EXPECT_GT(error.compared, 5000);
  EXPECT_EQ(error.largest_mm, 0.0);
  EXPECT_LT(error.surface_rms_mm, kFloatMm);
  EXPECT_EQ(error.missing_share, 0.0);
  EXPECT_EQ(error.extra_share, 0.0);
}

TEST(DepthErrorOf, AWallMovedTowardsTheViewerIsThatMuchNearer) {
  constexpr double kMovedMm = 3.0;
  const DepthError error = Compare(Picture(Wall(0.0)), Picture(Wall(kMovedMm)));
  // Rays meet the wall at a slant of up to 12 degrees.
  EXPECT_GT(error.mean_mm, kMovedMm);
  EXPECT_LT(error.mean_mm, 1.02 * kMovedMm);
  EXPECT_NEAR(error.surface_mean_mm, kMovedMm, kFloatMm);
  EXPECT_NEAR(error.surface_rms_mm, kMovedMm, kFloatMm);
  EXPECT_NEAR(error.surface_p95_mm, kMovedMm, kFloatMm);
  const DepthError away = Compare(Picture(Wall(kMovedMm)), Picture(Wall(0.0)));
  EXPECT_LT(away.mean_mm, -kMovedMm);
}

TEST(DepthErrorOf, ABallOneMillimetreLargerIsOneMillimetreOffTheSurface) {
  constexpr double kRimMm = 0.15;  // the reference ends a pixel before its horizon
  const DepthError error = Compare(Picture(Ball(40.0)), Picture(Ball(41.0)));
  EXPECT_NEAR(error.surface_mean_mm, 1.0, kRimMm);
  EXPECT_NEAR(error.surface_rms_mm, 1.0, kRimMm);
  EXPECT_GT(error.rms_mm, 1.1);  // along the ray it is more: the rim is met at a slant
  EXPECT_GT(error.extra_share, 0.01);
  EXPECT_EQ(error.missing_share, 0.0);
  const DepthError smaller = Compare(Picture(Ball(41.0)), Picture(Ball(40.0)));
  EXPECT_EQ(smaller.extra_share, 0.0);
  EXPECT_GT(smaller.missing_share, 0.01);
  EXPECT_LT(smaller.mean_mm, 0.0);
}

TEST(DepthErrorOf, TalliesPoolWhatTheyAreGiven) {
  const SurfacePicture wall = Picture(Wall(0.0)), nearer = Picture(Wall(2.0)), farther = Picture(Wall(-2.0));
  constexpr double kBorderMm = 0.005;  // at the picture's border the reference ends
  ErrorTally tally;
  tally.Add(wall, nearer.depth(), 3);
  tally.Add(wall, farther.depth(), 3);
  const DepthError error = tally.Summary();
  EXPECT_NEAR(error.mean_mm, 0.0, kFloatMm);
  EXPECT_NEAR(error.surface_rms_mm, 2.0, kBorderMm);
  EXPECT_EQ(error.compared, 2LL * 67 * 54);
}

TEST(DistanceToTriangle, ToItsFaceEdgesAndCorners) {
  const Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  EXPECT_DOUBLE_EQ(DistanceToTriangle({1, 1, 2}, a, b, c), 2.0);
  EXPECT_DOUBLE_EQ(DistanceToTriangle({2, -3, 4}, a, b, c), 5.0);
  EXPECT_DOUBLE_EQ(DistanceToTriangle({7, 0, 4}, a, b, c), 5.0);
  EXPECT_DOUBLE_EQ(DistanceToTriangle({4, 3, 0}, a, b, c), 2.4);
  EXPECT_DOUBLE_EQ(DistanceToTriangle({3, 4, 0}, a, a, a), 5.0);
}

TEST(PictureOnPlanes, HasDepthsOfPlanesJustBehindTheSurface) {
  constexpr double kSpacingMm = 15.0;
  const std::array solids{Ball(80.0)};
  const auto contains = [&](const Vector3d& x) { return recon::Contains(solids[0], x); };
  const Eigen::AlignedBox3d workspace(Vector3d::Constant(-200.0), Vector3d::Constant(200.0));
  const recon::DepthMap planes = PictureOnPlanes(View(), workspace, kSpacingMm, contains, 1);
  const SurfacePicture exact = Picture(Ball(80.0));
  EXPECT_GT(planes.hit_pixels, 5000);
  for (std::size_t i = 0; i < planes.depth_mm.size(); ++i) {
    if (planes.depth_mm[i] == 0.0F) continue;
    const double plane = planes.depth_mm[i] / kSpacingMm;
    EXPECT_NEAR(plane, std::round(plane), kFloatMm);
    EXPECT_GE(planes.depth_mm[i], exact.depth().depth_mm[i] - kFloatMm);
    EXPECT_LE(planes.depth_mm[i], exact.depth().depth_mm[i] + kSpacingMm + kFloatMm);
  }
}

TEST(DrawMesh, ShowsAFlatTriangleAtItsDepth) {
  core::TriangleMesh mesh;
  mesh.vertices_mm = {{-50.0, 0.0, -50.0}, {50.0, 20.0, -50.0}, {0.0, 10.0, 60.0}};
  mesh.triangles = {{0, 1, 2}};
  const recon::DepthMap picture = DrawMesh(mesh, View());
  EXPECT_GT(picture.hit_pixels, 1000);
  const Vector3d normal = Vector3d(100.0, 20.0, 0.0).cross(Vector3d(50.0, 10.0, 110.0)).normalized();
  const SurfacePicture surface(View(), picture);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (surface.DepthAt(x, y) == 0.0) continue;
      const Vector3d point = surface.PointAt(x, y, surface.DepthAt(x, y));
      EXPECT_NEAR((point - mesh.vertices_mm[0]).dot(normal), 0.0, kFloatMm);
    }
  }
}

}  // namespace
}  // namespace elbowroom::accuracy
