// Distances to parts against every triangle, one by one, in long double.
#include "core/part_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// A tube around the x axis, of quads cut into triangles: every point near its axis is about as far from all
// of a ring.
TriangleMesh Tube(double radius_mm, double length_mm, int around, int along) {
  TriangleMesh mesh;
  for (int i = 0; i <= along; ++i) {
    for (int j = 0; j < around; ++j) {
      const double turn = 2.0 * M_PI * j / around;
      mesh.vertices_mm.emplace_back(length_mm * (static_cast<double>(i) / along - 0.5),
                                    radius_mm * std::cos(turn), radius_mm * std::sin(turn));
    }
  }
  const auto id = [&](int i, int j) { return static_cast<std::int32_t>(i * around + j % around); };
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i, j + 1)});
      mesh.triangles.push_back({id(i, j + 1), id(i + 1, j), id(i + 1, j + 1)});
    }
  }
  return mesh;
}

struct AllowedCase {
  TriangleMesh mesh;
  BoxInPart box;
};

AllowedCase RandomAllowedCase(Random* random, int trial) {
  AllowedCase result;
  result.mesh = trial % 2 == 0 ? RandomSoup(random, random->Whole(1, 60))
                               : Tube(random->Uniform(20.0, 90.0), 150.0, random->Whole(3, 40), 6);
  result.box.center = random->Uniform(0.0, 120.0) * random->Direction();
  const Vector3d half(random->LogUniform(0.1, 30.0), random->LogUniform(0.1, 30.0),
                      random->LogUniform(0.1, 30.0));
  result.box.half_edges = random->Rotation() * half.asDiagonal();
  result.box.enough_mm = random->Uniform(0.0, 100.0);
  result.box.allowance_mm = random->LogUniform(1e-3, 10.0);
  return result;
}

Vector3d RandomPointOf(const BoxInPart& box, Random* random) {
  const Vector3d at(random->Uniform(-1.0, 1.0), random->Uniform(-1.0, 1.0), random->Uniform(-1.0, 1.0));
  return box.center + box.half_edges * (random->Whole(0, 2) == 0 ? Vector3d(at.cwiseSign()) : at);
}

TEST(FindNearest, WithAnAllowanceIsOffByNoMore) {
  Random random(7103);
  int off = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const AllowedCase asked = RandomAllowedCase(&random, trial);
    const TriangleTree part(std::make_shared<const TriangleMesh>(asked.mesh));
    const NearestOnPart nearest = FindNearest(part, asked.box);
    const double true_mm = SlowDistance(asked.mesh, asked.box.center);
    ASSERT_GE(nearest.distance_mm, true_mm - kDistanceRoundingMm);
    ASSERT_LE(nearest.distance_mm, true_mm + asked.box.allowance_mm + kDistanceRoundingMm);
    ASSERT_NEAR((nearest.position_in_part - asked.box.center).norm(), nearest.distance_mm,
                kDistanceRoundingMm);
    ASSERT_LE(SlowDistance(asked.mesh, nearest.position_in_part), kDistanceRoundingMm) << "it is on the part";
    off += nearest.distance_mm > true_mm + kDistanceRoundingMm ? 1 : 0;
    for (int k = 0; k < 20; ++k) {
      ASSERT_GE(SlowDistance(asked.mesh, RandomPointOf(asked.box, &random)),
                nearest.box_lower_mm - kDistanceRoundingMm);
    }
    BoxInPart strict = asked.box;
    strict.allowance_mm = 0.0;
    const NearestOnPart exact = FindNearest(part, strict);
    const bool is_worked_out =
        exact.box_lower_mm > exact.distance_mm - strict.half_edges.norm() + kDistanceRoundingMm;
    if (is_worked_out && nearest.box_lower_mm >= strict.enough_mm) {
      ASSERT_GE(nearest.box_lower_mm, exact.box_lower_mm - 3.0 * asked.box.allowance_mm);
    }
  }
  EXPECT_GT(off, 20) << "the allowance is used";
}

TEST(FindNearStretch, HoldsAllThatIsNearer) {
  Random random(7104);
  int cut = 0, near = 0;
  for (int trial = 0; trial < 600; ++trial) {
    AllowedCase asked = RandomAllowedCase(&random, trial);
    if (trial % 3 == 0) asked.box.allowance_mm = 0.0;
    const TriangleTree part(std::make_shared<const TriangleMesh>(asked.mesh));
    const Eigen::Index axis = random.Whole(0, 2);
    const double within_mm = random.Uniform(0.3, 1.3) * SlowDistance(asked.mesh, asked.box.center);
    const auto likely =
        static_cast<std::uint32_t>(random.Whole(0, static_cast<int>(asked.mesh.triangles.size()) - 1));
    const NearStretch stretch = FindNearStretch(part, asked.box, axis, within_mm, likely);
    cut += stretch.length() < 1.6 ? 1 : 0;
    const NearStretch if_short = FindNearStretch(part, asked.box, axis, within_mm, likely, 1.6);
    const bool is_short = stretch.length() <= 1.6;
    ASSERT_EQ(if_short.from, is_short ? stretch.from : -1.0);
    ASSERT_EQ(if_short.to, is_short ? stretch.to : 1.0);
    for (int k = 0; k < 40; ++k) {
      const Vector3d x = RandomPointOf(asked.box, &random);
      if (SlowDistance(asked.mesh, x) >= within_mm - kDistanceRoundingMm) continue;
      ++near;
      const Vector3d half_edge = asked.box.half_edges.col(axis);
      const double at = half_edge.dot(x - asked.box.center) / half_edge.squaredNorm();
      ASSERT_GE(at, stretch.from - 1e-9);
      ASSERT_LE(at, stretch.to + 1e-9);
    }
  }
  EXPECT_GT(cut, 100);
  EXPECT_GT(near, 1000);
}

}  // namespace
}  // namespace elbowroom::core
