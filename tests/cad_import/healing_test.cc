#include "cad_import/normalisation/healing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "cad_import/normalisation/surface_topology.h"
#include "tests/core/solids.h"

namespace elbowroom::cad_import {
namespace {

using core::TriangleMesh;
using core::testing::Box;

OwnedMesh Owned(TriangleMesh mesh) {
  OwnedMesh body{std::move(mesh), {}};
  body.owner_of_triangle.assign(body.mesh.triangles.size(), 0);
  return body;
}

TriangleMesh Moved(TriangleMesh mesh, const Eigen::Vector3d& by_mm) {
  for (Eigen::Vector3d& vertex : mesh.vertices_mm) vertex += by_mm;
  return mesh;
}

void Turn(TriangleMesh& mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

TEST(Weld, MakesSoupOneSurfaceAgain) {
  const TriangleMesh box = Box({10, 20, 30});
  TriangleMesh soup;
  for (const auto& triangle : box.triangles) {
    const auto first = static_cast<std::int32_t>(soup.vertices_mm.size());
    for (const std::int32_t corner : triangle)
      soup.vertices_mm.push_back(box.vertices_mm[static_cast<std::size_t>(corner)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.vertices_mm[4].x() += 3e-17;  // a modeller's zero
  OwnedMesh body = Owned(soup);
  Weld(body);
  EXPECT_EQ(body.mesh.vertices_mm.size(), 8U);
  EXPECT_TRUE(core::IsWatertight(body.mesh));
}

TEST(Heal, LeavesASoundSurfaceAlone) {
  OwnedMesh body = Owned(Box({10, 20, 30}));
  const SurfaceReport report = Heal(body);
  EXPECT_EQ(body.mesh, Box({10, 20, 30}));
  EXPECT_EQ(report, (SurfaceReport{.watertight = true}));
}

TEST(Heal, MakesNeighboursRunAlikeAndOutwards) {
  std::mt19937 random(5501);
  for (int trial = 0; trial < 200; ++trial) {
    OwnedMesh body = Owned(Box({10, 20, 30}));
    std::int64_t turned = 0;
    for (auto& triangle : body.mesh.triangles) {
      if (random() % 2 == 0) continue;
      std::swap(triangle[1], triangle[2]);
      ++turned;
    }
    const SurfaceReport report = Heal(body);
    EXPECT_TRUE(report.watertight);
    EXPECT_NEAR(core::VolumeMm3(body.mesh), 6000.0, 1e-9);
    EXPECT_TRUE(turned == 0 ? report.turned == 0 : report.turned > 0);
  }
}

TEST(Heal, TurnsABoxInsideOutButNoCavity) {
  TriangleMesh outer = Box({10, 10, 10}), cavity = Moved(Box({2, 2, 2}), {4, 4, 4}),
               beside = Moved(Box({2, 2, 2}), {20, 0, 0});
  Turn(cavity);
  Turn(beside);
  TriangleMesh all = outer;
  core::Append(all, cavity);
  core::Append(all, beside);
  OwnedMesh body = Owned(all);
  const SurfaceReport report = Heal(body);
  EXPECT_EQ(report.turned, 12);  // the one beside
  EXPECT_NEAR(core::VolumeMm3(body.mesh), 1000.0 - 8.0 + 8.0, 1e-9);
}

TEST(Heal, DropsCopiesThatFaceTheSameWay) {
  OwnedMesh body = Owned(Box({10, 20, 30}));
  const auto copy = body.mesh.triangles[3];
  body.mesh.triangles.push_back({copy[1], copy[2], copy[0]});
  body.owner_of_triangle.push_back(0);
  const SurfaceReport report = Heal(body);
  EXPECT_EQ(report.dropped_duplicates, 1);
  EXPECT_TRUE(report.watertight);
  EXPECT_EQ(body.mesh.triangles.size(), 12U);
}

TEST(Heal, KeepsTheBackOfASheet) {
  OwnedMesh body = Owned({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}});
  const SurfaceReport report = Heal(body);
  EXPECT_EQ(body.mesh.triangles.size(), 2U);
  EXPECT_EQ(report.dropped_duplicates, 0);
}

TEST(Heal, CountsWhatItCannotMend) {
  TriangleMesh open = Box({1, 1, 1});
  open.triangles.pop_back();
  OwnedMesh body = Owned(open);
  SurfaceReport report = Heal(body);
  EXPECT_EQ(report.open_edges, 3);
  EXPECT_FALSE(report.watertight);

  TriangleMesh glued = Box({1, 1, 1});  // two boxes with one edge in common
  core::Append(glued, Moved(Box({1, 1, 1}), {1, 1, 0}));
  body = Owned(glued);
  Weld(body);
  report = Heal(body);
  EXPECT_EQ(report.non_manifold_edges, 1);
  EXPECT_FALSE(report.watertight);
}

TEST(Heal, AMoebiusStripIsLeftAsItIs) {
  constexpr int kSteps = 12;
  TriangleMesh strip;
  for (int i = 0; i < kSteps; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / kSteps;
    for (const double side : {-1.0, 1.0}) {
      const double r = 5.0 + side * std::cos(turn / 2.0);
      strip.vertices_mm.emplace_back(r * std::cos(turn), r * std::sin(turn), side * std::sin(turn / 2.0));
    }
  }
  for (int i = 0; i < kSteps; ++i) {
    const bool is_last = i + 1 == kSteps;
    const std::int32_t a = 2 * i, b = a + 1, c = is_last ? 1 : a + 2, d = is_last ? 0 : a + 3;
    strip.triangles.push_back({a, c, b});
    strip.triangles.push_back({b, c, d});
  }
  OwnedMesh body = Owned(strip);
  const SurfaceReport report = Heal(body);
  EXPECT_EQ(report.turned, 0);
  EXPECT_EQ(report.inconsistent_edges, 1);
}

TEST(Heal, NothingIsNothing) {
  OwnedMesh body;
  Weld(body);
  EXPECT_FALSE(Heal(body).watertight);
}

}  // namespace
}  // namespace elbowroom::cad_import
