// Held against every triangle of every part, one after the other.
#include "app/control/picking/pick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/units.h"
#include "recon/appearance/orbit_camera.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

// In mm: how far the tree and the plain search may differ, both in double.
constexpr double kRoundingMm = 1e-7;

core::SharedMesh Cube(double size_mm) {
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.push_back(size_mm * Vector3d(i & 1, (i >> 1) & 1, (i >> 2) & 1));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

// A ball with bumps, so that rays meet it several times.
core::SharedMesh BumpyBall(int rings, double radius_mm) {
  core::TriangleMesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double polar = std::numbers::pi * i / rings, around = 2.0 * std::numbers::pi * j / columns;
      const double r = radius_mm * (1.0 + 0.3 * std::sin(5.0 * polar) * std::cos(7.0 * around));
      mesh.vertices_mm.emplace_back(r * std::sin(polar) * std::cos(around),
                                    r * std::sin(polar) * std::sin(around), r * std::cos(polar));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < columns; ++j) {
      const int a = i * columns + j, b = i * columns + (j + 1) % columns;
      mesh.triangles.push_back({a, a + columns, b});
      mesh.triangles.push_back({b, a + columns, b + columns});
    }
  }
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

PickablePart At(const core::SharedMesh& mesh, const Vector3d& position_mm, const Vector3d& rpy_deg) {
  return {std::make_shared<const core::TriangleTree>(mesh),
          core::FromPositionAndRollPitchYaw(position_mm, rpy_deg)};
}

// The oracle: corners in world, a plane and three sides. No tree and no barycentric coordinates.
std::optional<Pick> SlowPick(const std::vector<PickablePart>& parts, const PickRay& ray) {
  std::optional<Pick> pick;
  for (core::PartIndex i = 0; i < parts.size(); ++i) {
    const core::TriangleMesh& mesh = parts[i].tree->mesh();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      std::array<Vector3d, 3> corner;
      for (std::size_t k = 0; k < 3; ++k)
        corner[k] =
            parts[i].world_from_part * mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[t][k])];
      const Vector3d across = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
      if (across.norm() == 0.0) continue;
      const Vector3d normal = across.normalized();
      const double distance_mm =
          normal.dot(corner[0] - ray.origin_in_world) / normal.dot(ray.direction_in_world);
      if (!(distance_mm >= 0.0) || (pick && distance_mm >= pick->distance_mm)) continue;
      const Vector3d point = ray.origin_in_world + distance_mm * ray.direction_in_world;
      bool is_inside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d side = corner[(k + 1) % 3] - corner[k];
        is_inside &= normal.dot(side.cross(point - corner[k])) >= 0.0;
      }
      if (is_inside) pick = Pick{i, t, distance_mm, point, normal};
    }
  }
  return pick;
}

TEST(PickPart, NamesPartPointAndNormalOfACubeInFront) {
  const std::vector parts{At(Cube(10.0), {100.0, -5.0, -5.0}, {0.0, 0.0, 0.0}),
                          At(Cube(10.0), {50.0, -5.0, -5.0}, {0.0, 0.0, 0.0})};
  const auto pick = PickPart(parts, {Vector3d(0.0, 1.0, 2.0), Vector3d::UnitX()});
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->part, 1U);
  EXPECT_DOUBLE_EQ(pick->distance_mm, 50.0);
  EXPECT_TRUE(pick->point_in_world.isApprox(Vector3d(50.0, 1.0, 2.0)));
  EXPECT_TRUE(pick->normal_in_world.isApprox(-Vector3d::UnitX()));
}

TEST(PickPart, FindsNothingBesideOrBehind) {
  const std::vector parts{At(Cube(10.0), {50.0, -5.0, -5.0}, {0.0, 0.0, 0.0})};
  EXPECT_FALSE(PickPart(parts, {Vector3d(0.0, 30.0, 0.0), Vector3d::UnitX()}));
  EXPECT_FALSE(PickPart(parts, {Vector3d(0.0, 0.0, 0.0), -Vector3d::UnitX()}));
  EXPECT_FALSE(PickPart({}, {Vector3d::Zero(), Vector3d::UnitX()}));
  EXPECT_FALSE(PickPart(std::vector<PickablePart>(2), {Vector3d::Zero(), Vector3d::UnitX()}));
}

TEST(PickPart, FromInsideMeetsTheFaceBehindWhichPointsAlongTheRay) {
  const std::vector parts{At(Cube(10.0), {-5.0, -5.0, -5.0}, {0.0, 0.0, 0.0})};
  const auto pick = PickPart(parts, {Vector3d(0.0, 1.0, 2.0), Vector3d::UnitX()});
  ASSERT_TRUE(pick);
  EXPECT_DOUBLE_EQ(pick->distance_mm, 5.0);
  EXPECT_GT(pick->normal_in_world.x(), 0.9);
}

TEST(PickPart, LeavesOutWhatIsNearerThanTheCut) {
  const std::vector parts{At(Cube(10.0), {50.0, -5.0, -5.0}, {0.0, 0.0, 0.0})};
  const auto pick = PickPart(parts, {Vector3d(0.0, 1.0, 2.0), Vector3d::UnitX()}, 55.0);
  ASSERT_TRUE(pick);
  EXPECT_DOUBLE_EQ(pick->distance_mm, 60.0);
}

// Every face of a cube is two triangles: rays at their common edge and at corners meet one of them.
TEST(PickPart, NoRaySlipsThroughAnEdgeBetweenTriangles) {
  const std::vector parts{At(Cube(10.0), {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0})};
  for (int i = 0; i <= 100; ++i) {
    const double along = 0.1 * i;
    EXPECT_TRUE(PickPart(parts, {Vector3d(along, along, -50.0), Vector3d::UnitZ()})) << along;
  }
}

TEST(PickPart, EqualsTheSearchThroughAllTriangles) {
  std::mt19937 random(25);
  std::uniform_real_distribution<double> place(-150.0, 150.0), turn(-180.0, 180.0), near(-60.0, 60.0);
  const auto vector = [&](auto& of) { return Vector3d(of(random), of(random), of(random)); };
  const core::SharedMesh ball = BumpyBall(24, 40.0), cube = Cube(60.0);
  int met = 0;
  for (int scene = 0; scene < 8; ++scene) {
    std::vector<PickablePart> parts;
    for (int i = 0; i < 4; ++i) parts.push_back(At(i % 2 ? ball : cube, vector(place), vector(turn)));
    for (int i = 0; i < 250; ++i) {
      const Vector3d eye = 4.0 * vector(place);
      const Vector3d target = parts[static_cast<std::size_t>(i % 4)].world_from_part * vector(near);
      const PickRay ray{eye, (target - eye).normalized()};
      const auto slow = SlowPick(parts, ray), fast = PickPart(parts, ray);
      ASSERT_EQ(slow.has_value(), fast.has_value()) << scene << " " << i;
      if (!slow) continue;
      ++met;
      EXPECT_NEAR(slow->distance_mm, fast->distance_mm, kRoundingMm);
      EXPECT_EQ(slow->part, fast->part);
      EXPECT_EQ(slow->triangle, fast->triangle);
      EXPECT_LT((slow->point_in_world - fast->point_in_world).norm(), kRoundingMm);
      EXPECT_LT((slow->normal_in_world - fast->normal_in_world).norm(), 1e-9);
    }
  }
  EXPECT_GT(met, 800);  // the comparison isn't one of misses
}

TEST(RayThrough, GoesThroughWhatThePixelShows) {
  recon::OrbitCamera camera;
  camera.target_in_world = Vector3d(10.0, 20.0, 30.0);
  const recon::SceneView view = recon::ViewFrom(camera, 640, 480);
  const Vector3d x_in_world(100.0, -80.0, 60.0);
  const auto pixel = view.Project(x_in_world);
  ASSERT_TRUE(pixel);
  const PickRay ray = RayThrough(view, *pixel);
  const Vector3d to_point = x_in_world - ray.origin_in_world;
  EXPECT_NEAR(ray.direction_in_world.norm(), 1.0, 1e-12);
  EXPECT_LT(to_point.cross(ray.direction_in_world).norm(), 1e-8);
  EXPECT_GT(to_point.dot(ray.direction_in_world), 0.0);
}

}  // namespace
}  // namespace elbowroom::control
