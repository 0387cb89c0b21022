// Distances to parts against every triangle, one by one, in long double.
#include "core/part_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::core {
namespace {

using Eigen::Vector3d;
using recon::Random;
using Wide = Eigen::Matrix<long double, 3, 1>;

constexpr double kDistanceRoundingMm = 1e-9;

Wide NearestOnSide(const Wide& x, const Wide& a, const Wide& b) {
  const Wide ab = b - a;
  const long double length2 = ab.squaredNorm();
  const long double share = length2 > 0 ? std::clamp(ab.dot(x - a) / length2, 0.0L, 1.0L) : 0.0L;
  return a + share * ab;
}

// The foot point on the plane if the sides have it to their left; else the nearest of the sides.
long double DistanceTo(const Wide& x, const Wide& a, const Wide& b, const Wide& c) {
  long double nearest = std::min({(NearestOnSide(x, a, b) - x).norm(), (NearestOnSide(x, b, c) - x).norm(),
                                  (NearestOnSide(x, c, a) - x).norm()});
  const Wide normal = (b - a).cross(c - a);
  if (normal.squaredNorm() == 0) return nearest;
  const auto is_left = [&](const Wide& p, const Wide& q) { return normal.dot((q - p).cross(x - p)) >= 0; };
  if (is_left(a, b) && is_left(b, c) && is_left(c, a))
    nearest = std::min(nearest, std::abs(normal.dot(x - a)) / normal.norm());
  return nearest;
}

// Plain triangles, needles, slivers, triangles without area.
TriangleMesh RandomSoup(Random* random, int triangles) {
  TriangleMesh mesh;
  for (std::int32_t i = 0; i < triangles; ++i) {
    const Vector3d a = random->Uniform(0.0, 100.0) * random->Direction();
    const double size = random->LogUniform(1e-3, 60.0), thin = random->LogUniform(1e-9, 1.0);
    const Vector3d b = i % 9 == 0 ? a : Vector3d(a + size * random->Direction());
    const Vector3d c = a + random->Uniform(-0.5, 1.5) * (b - a) + size * thin * random->Direction();
    mesh.vertices_mm.insert(mesh.vertices_mm.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

double SlowDistance(const TriangleMesh& mesh, const Vector3d& x) {
  long double nearest = HUGE_VALL;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto vertex = [&](std::int32_t i) -> Wide {
      return mesh.vertices_mm[static_cast<std::size_t>(i)].cast<long double>();
    };
    nearest = std::min(nearest, DistanceTo(x.cast<long double>(), vertex(a), vertex(b), vertex(c)));
  }
  return static_cast<double>(nearest);
}

TEST(FindNearest, IsTheNearestOfAllTriangles) {
  Random random(7101);
  for (int trial = 0; trial < 150; ++trial) {
    const auto mesh = std::make_shared<const TriangleMesh>(RandomSoup(&random, random.Whole(1, 60)));
    const TriangleTree part(mesh);
    for (int i = 0; i < 20; ++i) {
      const Vector3d x = random.Uniform(0.0, 150.0) * random.Direction();
      const auto likely =
          static_cast<std::uint32_t>(random.Whole(0, static_cast<int>(mesh->triangles.size()) - 1));
      const NearestOnPart nearest = FindNearest(part, {.center = x}, likely);
      ASSERT_NEAR(nearest.distance_mm, SlowDistance(*mesh, x), kDistanceRoundingMm);
      ASSERT_NEAR((nearest.position_in_part - x).norm(), nearest.distance_mm, kDistanceRoundingMm);
      ASSERT_LE(SlowDistance(*mesh, nearest.position_in_part), kDistanceRoundingMm) << "it is on the part";
      ASSERT_NEAR(nearest.box_lower_mm, nearest.distance_mm, kDistanceRoundingMm) << "a point is its own box";
    }
  }
}

TEST(FindNearest, BoxesAreNoNearerThanTheirBound) {
  Random random(7102);
  std::int64_t better = 0, boxes = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const auto mesh = std::make_shared<const TriangleMesh>(RandomSoup(&random, random.Whole(1, 30)));
    const TriangleTree part(mesh);
    for (int i = 0; i < 10; ++i) {
      BoxInPart box;
      box.center = random.Uniform(0.0, 150.0) * random.Direction();
      const Vector3d half(random.LogUniform(0.1, 30.0), random.LogUniform(0.1, 30.0),
                          random.LogUniform(0.1, 30.0));
      box.half_edges = random.Rotation() * half.asDiagonal();
      box.enough_mm = random.Uniform(0.0, 100.0);
      const NearestOnPart nearest = FindNearest(part, box);
      ++boxes;
      better += nearest.box_lower_mm > nearest.distance_mm - half.norm() + kDistanceRoundingMm ? 1 : 0;
      for (int k = 0; k < 30; ++k) {
        const Vector3d at(random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0));
        // Corners as well as what lies between.
        const Vector3d in_box = k < 8 ? Vector3d(at.cwiseSign()) : at;
        ASSERT_GE(SlowDistance(*mesh, box.center + box.half_edges * in_box),
                  nearest.box_lower_mm - kDistanceRoundingMm);
      }
    }
  }
  EXPECT_GT(better, boxes / 10) << "than the ball's around the box, where that is asked for";
}

}  // namespace
}  // namespace elbowroom::core
