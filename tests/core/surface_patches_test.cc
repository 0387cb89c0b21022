#include "core/surface_patches.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "core/error.h"
#include "tests/core/solids.h"

namespace elbowroom::core {
namespace {

using Eigen::Vector3d;

constexpr double kRoundingMm2 = 1e-9;  // sums of a few hundred areas of some mm2

SharedMesh Shared(TriangleMesh mesh) { return std::make_shared<const TriangleMesh>(std::move(mesh)); }

Vector3d AreaVector(const SurfacePatches::Corners& p) { return 0.5 * (p.b - p.a).cross(p.c - p.a); }

TEST(SurfacePatches, CoverEachTriangleOnceAndTurnAsItDoes) {
  const SharedMesh mesh = Shared(testing::Box({30.0, 47.0, 8.0}));
  const SurfacePatches patches(mesh, 10.0);
  for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
    const auto& [a, b, c] = mesh->triangles[t];
    const auto vertex = [&](std::int32_t i) { return mesh->vertices_mm[static_cast<std::size_t>(i)]; };
    const Vector3d whole = AreaVector({vertex(a), vertex(b), vertex(c)});
    Vector3d sum = Vector3d::Zero();
    ASSERT_EQ(patches.CornersOf(t).size(), patches.EndOf(t) - patches.FirstOf(t));
    for (const SurfacePatches::Corners& corners : patches.CornersOf(t)) {
      EXPECT_GT(AreaVector(corners).dot(whole), 0.0) << "turned over";
      const std::array<Vector3d, 3> sides{corners.b - corners.a, corners.c - corners.b,
                                          corners.a - corners.c};
      for (const Vector3d& side : sides) EXPECT_LE(side.norm(), 10.0 + 1e-12);
      sum += AreaVector(corners);
    }
    EXPECT_LT((sum - whole).norm(), kRoundingMm2);
  }
}

TEST(SurfacePatches, PointsAreFoundOnTheirPatch) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-50.0, 50.0), unit(0.05, 0.9);
  for (int trial = 0; trial < 300; ++trial) {
    TriangleMesh mesh;
    for (int i = 0; i < 3; ++i)
      mesh.vertices_mm.emplace_back(uniform(random), uniform(random), uniform(random));
    mesh.triangles = {{0, 1, 2}};
    const SurfacePatches patches(Shared(mesh), 7.0);
    const std::vector<SurfacePatches::Corners> all = patches.CornersOf(0);
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const SurfacePatches::Corners& corners = all[k];
      const double u = unit(random), v = unit(random) * (0.95 - u);
      const Vector3d x = corners.a + u * (corners.b - corners.a) + v * (corners.c - corners.a);
      EXPECT_EQ(patches.PatchAt(0, x), k);
    }
  }
}

TEST(SurfacePatches, APointOffTheTriangleAndATriangleWithoutAreaHaveAPatchToo) {
  TriangleMesh mesh;
  mesh.vertices_mm = {{0, 0, 0}, {40, 0, 0}, {0, 40, 0}, {80, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  const SurfacePatches patches(Shared(mesh), 10.0);
  for (const Vector3d& x : {Vector3d(-1e-9, 41, 0), Vector3d(41, -1, 3), Vector3d(-5, -5, 0)}) {
    EXPECT_LT(patches.PatchAt(0, x), patches.EndOf(0));
    EXPECT_GE(patches.PatchAt(1, x), patches.FirstOf(1));
    EXPECT_LT(patches.PatchAt(1, x), patches.size());
  }
}

TEST(SurfacePatches, AFineMeshIsItsOwnPatchesAndAHugeTriangleHasAMost) {
  TriangleMesh mesh;
  mesh.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e6, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 2}};
  const SurfacePatches patches(Shared(mesh), 10.0);
  EXPECT_EQ(patches.EndOf(0), 1U);
  EXPECT_EQ(patches.EndOf(1) - patches.FirstOf(1), std::size_t{1} << SurfacePatches::kMostHalvings);
  EXPECT_EQ(SurfacePatches(Shared({}), 10.0).size(), 0U);
  EXPECT_THROW(SurfacePatches(Shared({}), 0.0), PreconditionError);
}

}  // namespace
}  // namespace elbowroom::core
