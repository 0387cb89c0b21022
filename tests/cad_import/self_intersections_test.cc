// Against all common points of two triangles, found in rational numbers.
#include "cad_import/normalisation/self_intersections.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "tests/core/solids.h"
#include "tests/support/soak.h"

namespace elbowroom::cad_import {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Vec = std::array<Rational, 3>;
using Tri = std::array<Vec, 3>;

Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec Along(const Vec& from, const Rational& t, const Vec& way) {
  return {from[0] + t * way[0], from[1] + t * way[1], from[2] + t * way[2]};
}
Vec Cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational Dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
bool IsZero(const Vec& a) { return Dot(a, a) == 0; }

Vec NormalOf(const Tri& t) { return Cross(t[1] - t[0], t[2] - t[0]); }

// Of a point in the triangle's plane.
bool IsIn(const Vec& x, const Tri& t) {
  const Vec normal = NormalOf(t);
  for (std::size_t i = 0; i < 3; ++i)
    if (Dot(Cross(t[(i + 1) % 3] - t[i], x - t[i]), normal) < 0) return false;
  return true;
}

// Where a side meets a triangle: what ends their common points.
void AddEnds(const Vec& p, const Vec& q, const Tri& t, std::vector<Vec>* ends) {
  const Vec normal = NormalOf(t);
  const Rational from = Dot(p - t[0], normal), to = Dot(q - t[0], normal);
  if (from == 0 && IsIn(p, t)) ends->push_back(p);
  if (to == 0 && IsIn(q, t)) ends->push_back(q);
  if (from * to < 0) {
    const Vec x = Along(p, from / (from - to), q - p);
    if (IsIn(x, t)) ends->push_back(x);
  }
  if (from != 0 || to != 0) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec &a = t[i], &b = t[(i + 1) % 3], along = q - p, side = b - a;
    const Vec across = Cross(along, side);
    if (IsZero(across)) continue;  // parallel: ends at corners
    const Rational s = Dot(Cross(a - p, side), across) / Dot(across, across);
    const Rational u = Dot(Cross(a - p, along), across) / Dot(across, across);
    if (s >= 0 && s <= 1 && u >= 0 && u <= 1) ends->push_back(Along(p, s, along));
  }
}

std::vector<Vec> CommonEnds(const Tri& a, const Tri& b) {
  std::vector<Vec> ends;
  for (std::size_t i = 0; i < 3; ++i) {
    AddEnds(a[i], a[(i + 1) % 3], b, &ends);
    AddEnds(b[i], b[(i + 1) % 3], a, &ends);
  }
  return ends;
}

// A vertex at whole millimetres.
Vec VertexAt(const core::TriangleMesh& mesh, std::int32_t vertex) {
  const Eigen::Vector3d& x = mesh.vertices_mm[static_cast<std::size_t>(vertex)];
  return {std::lround(x.x()), std::lround(x.y()), std::lround(x.z())};
}

Tri TriOf(const core::TriangleMesh& mesh, std::size_t i) {
  const auto& [a, b, c] = mesh.triangles[i];
  return {VertexAt(mesh, a), VertexAt(mesh, b), VertexAt(mesh, c)};
}

// Do they meet elsewhere than in a corner or side that they share? All ends of their common points lie there
// if not.
bool Meet(const core::TriangleMesh& mesh) {
  std::vector<Vec> shared;
  for (const std::int32_t corner : mesh.triangles[0])
    for (const std::int32_t other : mesh.triangles[1])
      if (corner == other) shared.push_back(VertexAt(mesh, corner));
  if (shared.size() == 3) return false;
  for (const Vec& end : CommonEnds(TriOf(mesh, 0), TriOf(mesh, 1))) {
    if (shared.empty()) return true;
    if (shared.size() == 1 && !(end == shared[0])) return true;
    if (shared.size() == 2 && !IsZero(Cross(end - shared[0], shared[1] - shared[0]))) return true;
  }
  return false;
}

// Corners of a coarse lattice: touching, lying in one plane and crossing in corners are common.
std::optional<core::TriangleMesh> RandomPair(std::mt19937_64* random) {
  core::TriangleMesh mesh;
  std::vector<std::array<int, 3>> places;
  while (places.size() < 6) {
    const std::array<int, 3> place{static_cast<int>((*random)() % 4), static_cast<int>((*random)() % 4),
                                   static_cast<int>((*random)() % 3)};
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  }
  for (const auto& [x, y, z] : places) mesh.vertices_mm.emplace_back(x, y, z);
  const auto shared = static_cast<std::int32_t>((*random)() % 4);
  mesh.triangles = {{0, 1, 2}, {0, 0, 0}};
  for (std::int32_t k = 0; k < 3; ++k)
    mesh.triangles[1][static_cast<std::size_t>(k)] = k < shared ? k : k + 3;
  std::ranges::shuffle(mesh.triangles[1], *random);
  if (IsZero(NormalOf(TriOf(mesh, 0))) || IsZero(NormalOf(TriOf(mesh, 1)))) return std::nullopt;
  return mesh;
}

TEST(SelfIntersections, OfTwoTrianglesAreThoseOfRationalNumbers) {
  std::mt19937_64 random(20261122);
  const int trials = 5'000 * test_support::SoakScale();
  int meeting = 0, apart = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const std::optional<core::TriangleMesh> mesh = RandomPair(&random);
    if (!mesh) continue;
    const bool meet = Meet(*mesh);
    const SelfIntersections found = FindSelfIntersections(*mesh);
    ASSERT_EQ(found.pairs, meet ? 1 : 0) << "trial " << trial;
    ASSERT_EQ(found.triangles.size(), meet ? 2U : 0U);
    ++(meet ? meeting : apart);
  }
  EXPECT_GT(meeting, trials / 8);
  EXPECT_GT(apart, trials / 8);
}

TEST(SelfIntersections, ASoundSurfaceHasNone) {
  EXPECT_EQ(FindSelfIntersections(core::testing::Box({10, 20, 30})).pairs, 0);
  EXPECT_EQ(FindSelfIntersections({}).pairs, 0);
}

TEST(SelfIntersections, TrianglesWithoutAreaMeetNothing) {
  core::TriangleMesh mesh = core::testing::Box({10, 10, 10});
  mesh.vertices_mm.insert(mesh.vertices_mm.end(), {{5, 5, -5}, {5, 5, 5}, {5, 5, 15}});
  mesh.triangles.push_back({8, 9, 10});
  EXPECT_EQ(FindSelfIntersections(mesh).pairs, 0);
}

TEST(SelfIntersections, OfBoxesThatOverlapAreWhereTheirSurfacesCross) {
  core::TriangleMesh mesh = core::testing::Box({10, 10, 10});
  core::Append(mesh, core::Transformed(mesh, {Eigen::Matrix3d::Identity(), {5, 5, 5}}));
  const SelfIntersections found = FindSelfIntersections(mesh);
  EXPECT_GE(found.pairs, 6);  // three faces of each cross three of the other in two lines
  EXPECT_LE(found.triangles.size(), 12U);
  EXPECT_TRUE(std::ranges::is_sorted(found.triangles));
}

}  // namespace
}  // namespace elbowroom::cad_import
