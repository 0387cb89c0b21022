#include "tests/review/random_parts.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tests/core/solids.h"

namespace elbowroom::review::testing {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

double Between(double low, double high, std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
int Whole(int low, int high, std::mt19937_64& random) {
  return std::uniform_int_distribution<int>(low, high)(random);
}
Vector3d AnyVector(std::mt19937_64& random) {
  return {Between(-1, 1, random), Between(-1, 1, random), Between(-1, 1, random)};
}

// Even whole sides, so that it ends at whole millimetres.
TriangleMesh CenteredBox(std::mt19937_64& random) {
  const Vector3d size_mm(2 * Whole(2, 16, random), 2 * Whole(2, 16, random), 2 * Whole(2, 16, random));
  TriangleMesh box = core::testing::Box(size_mm);
  for (Vector3d& vertex : box.vertices_mm) vertex -= 0.5 * size_mm;
  return box;
}

// Each triangle cut in four.
TriangleMesh Finer(const TriangleMesh& coarse) {
  TriangleMesh fine{coarse.vertices_mm, {}};
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t i, std::int32_t j) {
    const auto [found, is_new] =
        middles.emplace(std::minmax(i, j), static_cast<std::int32_t>(fine.vertices_mm.size()));
    if (is_new) {
      const auto at = [&](std::int32_t k) { return coarse.vertices_mm[static_cast<std::size_t>(k)]; };
      fine.vertices_mm.push_back(0.5 * (at(i) + at(j)));
    }
    return found->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& triangle : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      fine.triangles.push_back(triangle);
  }
  return fine;
}

TriangleMesh LumpyBall(std::mt19937_64& random) {
  TriangleMesh ball{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int i = Whole(0, 2, random); i > 0; --i) ball = Finer(ball);
  const double radius_mm = Between(3, 18, random);
  for (Vector3d& vertex : ball.vertices_mm)
    vertex = radius_mm * Between(0.8, 1.2, random) * vertex.normalized();
  return ball;
}

TriangleMesh Prism(std::mt19937_64& random) {
  const std::int32_t sides = Whole(3, 24, random);
  const double radius_mm = Between(2, 15, random), half_mm = Whole(1, 20, random);
  TriangleMesh prism;
  for (std::int32_t i = 0; i < sides; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / sides;
    const double x = radius_mm * std::cos(angle_rad), y = radius_mm * std::sin(angle_rad);
    prism.vertices_mm.emplace_back(x, y, -half_mm);
    prism.vertices_mm.emplace_back(x, y, half_mm);
    const std::int32_t low = 2 * i, next = 2 * ((i + 1) % sides);
    prism.triangles.push_back({low, next, low + 1});
    prism.triangles.push_back({next, next + 1, low + 1});
    if (i < 2) continue;
    prism.triangles.push_back({0, low, low - 2});
    prism.triangles.push_back({1, low - 1, low + 1});
  }
  return prism;
}

TriangleMesh Soup(std::mt19937_64& random) {
  TriangleMesh soup;
  for (std::int32_t i = 0; i < 40; ++i) {
    const Vector3d middle = 15.0 * AnyVector(random);
    for (int corner = 0; corner < 3; ++corner) soup.vertices_mm.push_back(middle + 4.0 * AnyVector(random));
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return soup;
}

TriangleMesh Panel(std::mt19937_64& random) {
  constexpr std::int32_t kCells = 5;
  const double cell_mm = Whole(1, 6, random);
  TriangleMesh panel;
  for (std::int32_t y = 0; y <= kCells; ++y) {
    for (std::int32_t x = 0; x <= kCells; ++x) {
      panel.vertices_mm.emplace_back(cell_mm * (x - 2), cell_mm * (y - 2), 0.0);
      if (x == kCells || y == kCells) continue;
      const std::int32_t i = y * (kCells + 1) + x, above = i + kCells + 1;
      panel.triangles.push_back({i, i + 1, above});
      panel.triangles.push_back({i + 1, above + 1, above});
    }
  }
  return panel;
}

TriangleMesh NeedledBox(std::mt19937_64& random) {
  TriangleMesh box = CenteredBox(random);
  const auto count = static_cast<std::int32_t>(box.triangles.size());
  for (std::int32_t i = 0; i < count; ++i) {
    const auto [a, b, c] = box.triangles[static_cast<std::size_t>(i)];
    const auto at = [&](std::int32_t k) { return box.vertices_mm[static_cast<std::size_t>(k)]; };
    const auto added = static_cast<std::int32_t>(box.vertices_mm.size());
    const Vector3d on_edge = at(a) + Between(0, 1, random) * (at(b) - at(a));
    const Vector3d on_face = (at(a) + at(b) + at(c)) / 3.0;
    box.vertices_mm.insert(box.vertices_mm.end(), {on_edge, on_face});
    box.triangles.push_back({a, added, b});
    box.triangles.push_back({c, added + 1, added + 1});
    box.triangles.push_back({added + 1, added + 1, added + 1});
  }
  return box;
}

}  // namespace

TriangleMesh MakePart(PartKind kind, std::mt19937_64& random) {
  switch (kind) {
    case PartKind::kBox:
      return CenteredBox(random);
    case PartKind::kLumpyBall:
      return LumpyBall(random);
    case PartKind::kPrism:
      return Prism(random);
    case PartKind::kSoup:
      return Soup(random);
    case PartKind::kPanel:
      return Panel(random);
    case PartKind::kNeedledBox:
      return NeedledBox(random);
  }
  return {};
}

core::RigidTransform AnyPose(std::mt19937_64& random, double reach_mm) {
  return core::FromPositionAndRollPitchYaw(reach_mm * AnyVector(random), 180.0 * AnyVector(random));
}

PairOfPoses MakePoses(std::mt19937_64& random) {
  const int way = Whole(0, 3, random);
  if (way == 0) return {AnyPose(random, 30.0), AnyPose(random, 30.0)};
  if (way == 1) return {AnyPose(random, 1.0), AnyPose(random, 1.0)};
  const auto quarter = [&] { return 90.0 * Whole(0, 3, random); };
  const auto whole = [&] { return 1.0 * Whole(-25, 25, random); };
  PairOfPoses poses;
  poses.world_from_b =
      core::FromPositionAndRollPitchYaw({whole(), whole(), whole()}, {quarter(), quarter(), quarter()});
  if (way == 2) return poses;
  const core::RigidTransform turn = AnyPose(random, 30.0);
  return {turn * poses.world_from_a, turn * poses.world_from_b};
}

}  // namespace elbowroom::review::testing
