// The first triangle on a ray, and any: held against each other and against every triangle. The pick under
// the pointer and the sight lines of the overlay have tests of their own (pick_test, overlay_pieces_test).
#include "core/mesh_queries/mesh_ray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "tests/core/solids.h"

namespace elbowroom::core {
namespace {

using Eigen::Vector3d;

TriangleTree BoxTree() {
  return TriangleTree(std::make_shared<const TriangleMesh>(testing::Box({100.0, 80.0, 60.0})));
}

TEST(MeshRay, IsMetWhereItEntersAndNotBeyondItsEnds) {
  const TriangleTree tree = BoxTree();
  MeshRay ray{{-50.0, 30.0, 20.0}, {2.0, 0.0, 0.0}};
  ASSERT_TRUE(FirstMet(tree, ray));
  EXPECT_EQ(FirstMet(tree, ray)->at, 25.0);  // in lengths of the direction
  ray.from = 25.5;
  EXPECT_EQ(FirstMet(tree, ray)->at, 75.0);  // from inside
  ray.to = 74.5;
  EXPECT_FALSE(FirstMet(tree, ray));
  EXPECT_FALSE(MeetsAny(tree, ray));
  EXPECT_FALSE(FirstMet(TriangleTree(std::make_shared<const TriangleMesh>()), MeshRay{}));
}

TEST(MeshRay, NoneSlipsThroughAnEdgeOrACorner) {
  const TriangleTree tree = BoxTree();
  for (const Vector3d& corner : {Vector3d(0, 0, 0), Vector3d(100, 80, 60), Vector3d(50, 40, 0)}) {
    for (int i = 0; i < 100; ++i) {
      const Vector3d origin(300.0 * std::cos(i), 300.0 * std::sin(i), 200.0 * std::cos(3.0 * i));
      EXPECT_TRUE(MeetsAny(tree, {origin, corner - origin})) << i;
    }
  }
}

TEST(MeshRay, TheFirstIsTheNearestOfAllTriangles) {
  std::mt19937_64 engine(20250);
  std::uniform_real_distribution<double> at(-100.0, 100.0);
  auto mesh = std::make_shared<TriangleMesh>();
  for (std::int32_t i = 0; i < 300; ++i) {
    for (int k = 0; k < 3; ++k) mesh->vertices_mm.emplace_back(at(engine), at(engine), at(engine));
    mesh->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const TriangleTree tree(mesh);
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    const MeshRay ray{{2.0 * at(engine), 2.0 * at(engine), 2.0 * at(engine)},
                      {at(engine), at(engine), at(engine)},
                      0.2,
                      1.5};
    std::optional<MetTriangle> nearest;
    for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
      const auto corner = [&](std::uint32_t k) { return mesh->vertices_mm[3 * t + k]; };
      const auto here = MeetTriangle(ray.origin, ray.direction, corner(0), corner(1), corner(2));
      if (here && *here >= ray.from && *here <= ray.to && (!nearest || *here < nearest->at))
        nearest = MetTriangle{t, *here};
    }
    const std::optional<MetTriangle> first = FirstMet(tree, ray);
    ASSERT_EQ(first.has_value(), nearest.has_value());
    ASSERT_EQ(MeetsAny(tree, ray), nearest.has_value());
    if (!first) continue;
    ++met;
    ASSERT_EQ(first->triangle, nearest->triangle);
    ASSERT_EQ(first->at, nearest->at);
  }
  EXPECT_GT(met, 500);
}

}  // namespace
}  // namespace elbowroom::core
