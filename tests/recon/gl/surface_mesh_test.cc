#include "recon/gl/scene/surface_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "core/units.h"
#include "tests/recon/gl/sample_scene.h"

namespace elbowroom::recon::gl {
namespace {

constexpr double kSurfaceCreaseRad = core::RadiansFromDegrees(30.0);
constexpr float kRounding = 1e-5F;  // of unit vectors in single precision

Eigen::Vector3f VectorAt(const std::vector<float>& floats, std::size_t first) {
  return {floats[first], floats[first + 1], floats[first + 2]};
}

core::TriangleMesh WithLooseTriangles(const core::TriangleMesh& mesh) {
  core::TriangleMesh loose;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::int32_t>(loose.vertices_mm.size());
    for (const std::int32_t i : triangle)
      loose.vertices_mm.push_back(mesh.vertices_mm[static_cast<std::size_t>(i)]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  return loose;
}

TEST(PrepareSurface, BoxHasTwelveEdgesAndFlatFaces) {
  const core::SharedMesh box = BoxMesh({0, 0, 0}, {10, 20, 30});
  for (const core::TriangleMesh& mesh : {*box, WithLooseTriangles(*box)}) {
    const SurfaceMesh surface = PrepareSurface(mesh, kSurfaceCreaseRad);
    EXPECT_EQ(surface.feature_edges.size(), 12U * 6U);
    ASSERT_EQ(surface.corners.size(), 12U * 18U);
    for (std::size_t i = 3; i < surface.corners.size(); i += 6) {
      EXPECT_NEAR(VectorAt(surface.corners, i).lpNorm<Eigen::Infinity>(), 1.0F, kRounding);  // along an axis
    }
  }
}

TEST(PrepareSurface, TubeIsSmoothAroundAndCrispAtItsRims) {
  constexpr int kSides = 36;
  const SurfaceMesh surface = PrepareSurface(*TubeMesh(20, 10, 50, kSides), kSurfaceCreaseRad);
  EXPECT_EQ(surface.feature_edges.size(), 4U * kSides * 6U);  // inner and outer rim, top and bottom
  for (std::size_t i = 0; i < surface.corners.size(); i += 6) {
    const Eigen::Vector3f x = VectorAt(surface.corners, i);
    const Eigen::Vector3f normal = VectorAt(surface.corners, i + 3);
    if (std::abs(normal.z()) > 0.5F) {
      EXPECT_NEAR(std::abs(normal.z()), 1.0F, kRounding);
    } else {
      const Eigen::Vector2f radial = x.head<2>().normalized();
      EXPECT_NEAR(std::abs(radial.dot(normal.head<2>())), 1.0F, kRounding);  // as the true cylinder's
    }
  }
}

TEST(PrepareSurface, OpenSheetsKeepTheirBoundary) {
  const core::TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(PrepareSurface(sheet, kSurfaceCreaseRad).feature_edges.size(), 4U * 6U);
}

TEST(PrepareSurface, TriangleTurnedOverMakesNoEdge) {
  const core::TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 3, 2}}};
  EXPECT_EQ(PrepareSurface(sheet, kSurfaceCreaseRad).feature_edges.size(), 4U * 6U);
}

TEST(PrepareSurface, TrianglesWithoutAreaAreLeftOut) {
  core::TriangleMesh box = *BoxMesh({0, 0, 0}, {10, 20, 30});
  box.triangles.push_back({0, 1, 1});
  const SurfaceMesh surface = PrepareSurface(box, kSurfaceCreaseRad);
  EXPECT_EQ(surface.corners.size(), 12U * 18U);
  EXPECT_EQ(surface.feature_edges.size(), 12U * 6U);
}

TEST(PrepareSurface, CreaseAngleDecides) {
  const auto roof = [](double turn_rad) {
    return core::TriangleMesh{
        {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {std::cos(turn_rad), 0, -std::sin(turn_rad)}},
        {{0, 1, 2}, {1, 0, 3}}};
  };
  EXPECT_EQ(PrepareSurface(roof(core::RadiansFromDegrees(29.0)), kSurfaceCreaseRad).feature_edges.size(),
            4U * 6U);
  EXPECT_EQ(PrepareSurface(roof(core::RadiansFromDegrees(31.0)), kSurfaceCreaseRad).feature_edges.size(),
            5U * 6U);
}

}  // namespace
}  // namespace elbowroom::recon::gl
