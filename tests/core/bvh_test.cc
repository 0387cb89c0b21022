#include "core/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include "core/error.h"

namespace elbowroom::core {
namespace {

using Eigen::Vector3d;

// Balls enclose by construction; what is left is the rounding of this test's own distances.
constexpr double kBallRounding = 1e-12;

class PointSource {
 public:
  explicit PointSource(std::uint64_t seed) : engine_(seed) {}
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vector3d Point(double size) { return {Uniform(-size, size), Uniform(-size, size), Uniform(-size, size)}; }

 private:
  std::mt19937_64 engine_;
};

SharedMesh Soup(PointSource* random, int triangles, const Vector3d& offset) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i < triangles; ++i) {
    const Vector3d at = offset + random->Point(100.0);
    for (int k = 0; k < 3; ++k) mesh->vertices_mm.push_back(at + random->Point(random->Uniform(0.0, 5.0)));
    const auto first = static_cast<std::int32_t>(3 * i);
    mesh->triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

bool Encloses(const Ball& ball, const Vector3d& x) {
  return (x - ball.center).norm() <= ball.radius_mm * (1.0 + kBallRounding);
}

// Discs allow for the rounding of the coordinates, in which this test's own distances round, too.
bool Encloses(const Disc& disc, const Vector3d& x) {
  const double rounding_mm = 1e-15 * x.norm();
  const Vector3d from_center = x - disc.center;
  const double height = disc.normal.dot(from_center);
  return std::abs(disc.normal.norm() - 1.0) < kBallRounding &&
         std::abs(height) <= disc.half_height_mm + rounding_mm &&
         (from_center - height * disc.normal).norm() <= disc.radius_mm + rounding_mm;
}

void ExpectEachTriangleOnce(const TriangleTree& tree) {
  std::vector<std::uint32_t> order(tree.order().begin(), tree.order().end()), once(order.size());
  std::ranges::sort(order);
  std::iota(once.begin(), once.end(), 0U);
  ASSERT_EQ(order, once);
  ASSERT_EQ(order.size(), tree.mesh().triangles.size());
}

void ExpectTreeHolds(const TriangleTree& tree) {
  ExpectEachTriangleOnce(tree);
  const auto nodes = tree.nodes();
  const auto count = static_cast<std::uint32_t>(tree.mesh().triangles.size());
  ASSERT_EQ(nodes[0].begin, 0U);
  ASSERT_EQ(nodes[0].end, count);
  for (const TriangleTree::Node& node : nodes) {
    ASSERT_LT(node.begin, node.end);
    if (node.left == 0) {
      EXPECT_LE(node.end - node.begin, 4U);
    } else {
      EXPECT_EQ(nodes[node.left].begin, node.begin);
      EXPECT_EQ(nodes[node.left].end, nodes[node.left + 1].begin);
      EXPECT_EQ(nodes[node.left + 1].end, node.end);
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      for (const std::int32_t vertex : tree.mesh().triangles[tree.order()[i]]) {
        const Vector3d& x = tree.mesh().vertices_mm[static_cast<std::size_t>(vertex)];
        ASSERT_TRUE(Encloses(node.ball, x));
        ASSERT_TRUE(Encloses(node.disc, x));
      }
    }
  }
}

TEST(TriangleTree, NodesEncloseTheirTriangles) {
  PointSource random(1);
  for (const int triangles : {1, 2, 4, 5, 8, 9, 100, 1000})
    ExpectTreeHolds(TriangleTree(Soup(&random, triangles, Vector3d::Zero())));
  ExpectTreeHolds(TriangleTree(Soup(&random, 200, Vector3d(1e7, -1e7, 3e6))));  // far from the origin
}

// Where a surface is smooth, discs are flat: a sphere's is as thick as the cap that it covers.
TEST(TriangleTree, DiscsLieAlongSmoothSurfaces) {
  constexpr int kRows = 40;
  constexpr double kRadiusMm = 60.0;
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i <= kRows; ++i) {
    for (int j = 0; j < 2 * kRows; ++j) {
      const double tilt = M_PI * i / kRows, turn = M_PI * j / kRows;
      mesh->vertices_mm.push_back(kRadiusMm * Vector3d(std::sin(tilt) * std::cos(turn),
                                                       std::sin(tilt) * std::sin(turn), std::cos(tilt)));
    }
  }
  const auto id = [](int i, int j) { return static_cast<std::int32_t>(2 * kRows * i + j % (2 * kRows)); };
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < 2 * kRows; ++j) {
      mesh->triangles.push_back({id(i, j), id(i + 1, j), id(i, j + 1)});
      mesh->triangles.push_back({id(i, j + 1), id(i + 1, j), id(i + 1, j + 1)});
    }
  }
  const TriangleTree tree(mesh);
  for (const TriangleTree::Node& node : tree.nodes()) {
    const double reach_mm = 2.0 * node.ball.radius_mm;
    if (reach_mm > 0.5 * kRadiusMm) continue;
    EXPECT_LE(node.disc.half_height_mm, reach_mm * reach_mm / kRadiusMm);
    EXPECT_LE(node.disc.radius_mm, reach_mm);
  }
}

TEST(TriangleTree, DuplicateAndPointTrianglesStillSplit) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices_mm = {Vector3d(1, 2, 3), Vector3d(4, 2, 3), Vector3d(1, 5, 3)};
  for (int i = 0; i < 50; ++i) {
    mesh->triangles.push_back({0, 1, 2});
    mesh->triangles.push_back({1, 1, 1});
  }
  ExpectTreeHolds(TriangleTree(mesh));
}

TEST(TriangleTree, ChildrenShrink) {
  // A tree that didn't sort by place would have children as large as their parents.
  PointSource random(2);
  const TriangleTree tree(Soup(&random, 2000, Vector3d::Zero()));
  double parents = 0.0, children = 0.0;
  for (const TriangleTree::Node& node : tree.nodes()) {
    if (node.left == 0) continue;
    parents += 2.0 * node.ball.radius_mm;
    children += tree.nodes()[node.left].ball.radius_mm + tree.nodes()[node.left + 1].ball.radius_mm;
  }
  constexpr double kShrink = 0.87;  // halving one side of a cube gives sqrt(9 / 12)
  EXPECT_LT(children, kShrink * parents);
}

TEST(TriangleTree, EmptyMeshHasNoNode) {
  EXPECT_TRUE(TriangleTree(std::make_shared<const TriangleMesh>()).nodes().empty());
  EXPECT_THROW(TriangleTree(nullptr), PreconditionError);
}

TEST(BallOf, IsTheSmallestBall) {
  PointSource random(3);
  for (int i = 0; i < 20'000; ++i) {
    const double thin = i % 3 == 0 ? 1e-6 : 1.0;  // needles and slivers
    const Vector3d offset = random.Point(i % 2 == 0 ? 1.0 : 1e5);
    const Vector3d a = offset + random.Point(1.0), b = offset + random.Point(1.0);
    const Vector3d c = i % 3 == 0 ? Vector3d(a + random.Uniform(-1, 2) * (b - a) + random.Point(thin))
                                  : Vector3d(offset + random.Point(1.0));
    const Ball ball = BallOf(a, b, c);
    for (const Vector3d& x : {a, b, c}) ASSERT_TRUE(Encloses(ball, x));
    // By hand: the smallest ball over every pair, or through all three.
    double smallest = HUGE_VAL;
    for (const auto& [p, q, other] : {std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}}) {
      const Vector3d middle = 0.5 * (p + q);
      if ((other - middle).norm() <= (p - middle).norm()) smallest = std::min(smallest, (p - middle).norm());
    }
    const double sides = (b - a).norm() * (c - b).norm() * (a - c).norm();
    const double area = 0.5 * (b - a).cross(c - a).norm();
    if (smallest == HUGE_VAL) smallest = sides / (4.0 * area);
    // Coordinates of 1e5 leave 1e-11 of a triangle of size 1.
    constexpr double kShare = 1e-6;
    ASSERT_LE(ball.radius_mm, smallest * (1.0 + kShare) + 1e-9) << i;
  }
}

TEST(BallOf, ZeroAreaTriangles) {
  const Vector3d a(1, 2, 3), b(4, 6, 3);
  EXPECT_EQ(BallOf(a, a, a).radius_mm, 0.0);
  EXPECT_EQ(BallOf(a, a, a).center, a);
  EXPECT_NEAR(BallOf(a, b, a).radius_mm, 2.5, 1e-9);
  EXPECT_NEAR(BallOf(a, 0.3 * a + 0.7 * b, b).radius_mm, 2.5, 1e-9);
}

}  // namespace
}  // namespace elbowroom::core
