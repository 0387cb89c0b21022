// Cut parts are closed and have the volume of what is left; kept while nothing changes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "app/control/demo_parts.h"
#include "app/control/section/filled_outline.h"
#include "app/control/section/mesh_cut.h"
#include "app/control/section/part_sections.h"
#include "tests/app/overlay/overlay_samples.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double AreaOf(const std::vector<FlatTriangle>& triangles) {
  double area = 0.0;
  for (const auto& [a, b, c] : triangles) {
    const Vector2d p = b - a, q = c - a;
    EXPECT_GE(p.x() * q.y() - p.y() * q.x(), 0.0) << "clockwise";
    area += 0.5 * (p.x() * q.y() - p.y() * q.x());
  }
  return area;
}

void AddLoop(const std::vector<Vector2d>& loop, std::vector<DirectedSegment>* segments) {
  for (std::size_t i = 0; i < loop.size(); ++i) segments->push_back({loop[i], loop[(i + 1) % loop.size()]});
}

TEST(FillOutline, FillsLoopsWithHolesAndIslands) {
  std::vector<DirectedSegment> segments;
  AddLoop({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, &segments);
  AddLoop({{2, 2}, {2, 8}, {8, 8}, {8, 2}}, &segments);  // a hole
  AddLoop({{4, 4}, {6, 5}, {4, 6}}, &segments);          // an island in it
  EXPECT_NEAR(AreaOf(FillOutline(segments)), 100.0 - 36.0 + 2.0, 1e-12);
  std::ranges::reverse(segments);  // in any order
  EXPECT_NEAR(AreaOf(FillOutline(segments)), 66.0, 1e-12);
  EXPECT_TRUE(FillOutline({}).empty());
}

recon::HalfSpace Across(Eigen::Index axis, double at_mm, bool keeps_above = false) {
  const double sign = keeps_above ? -1.0 : 1.0;
  return {sign * Vector3d::Unit(axis), sign * at_mm};
}

core::TriangleMesh Closed(const CutMesh& cut) {
  core::TriangleMesh closed = cut.surface;
  if (!cut.cut_faces.triangles.empty()) core::Append(closed, cut.cut_faces);
  return closed;
}

// Rounding of the plane's own place, over the sizes of the meshes here.
constexpr double kOffPlaneMm = 1e-9;

// What is kept on both sides of a plane makes up the whole, and each side is closed: its volume doesn't
// depend on where the origin is. Nothing of a side is beyond the plane.
void ExpectHalves(const core::TriangleMesh& mesh, const core::RigidTransform& world_from_mesh,
                  const recon::HalfSpace& half_space) {
  const double whole = core::VolumeMm3(mesh);
  double sum = 0.0;
  for (const double side : {1.0, -1.0}) {
    const recon::HalfSpace kept{side * half_space.outward, side * half_space.at_mm};
    const core::TriangleMesh closed = Closed(CutOpen(mesh, world_from_mesh, {{kept}}));
    if (closed.triangles.empty()) continue;
    const double volume = core::VolumeMm3(closed);
    const double elsewhere =
        core::VolumeMm3(core::Transformed(closed, {Eigen::Matrix3d::Identity(), {3e3, -2e3, 1e3}}));
    EXPECT_NEAR(elsewhere, volume, 1e-8 * (whole + 1e9));
    EXPECT_GE(volume, -1e-9 * whole);
    for (const Vector3d& vertex : closed.vertices_mm)
      ASSERT_LT(kept.BeyondMm(world_from_mesh * vertex), kOffPlaneMm);
    sum += volume;
  }
  EXPECT_NEAR(sum, whole, 1e-8 * whole);
}

std::vector<core::TriangleMesh> Meshes() {
  return {BoxMesh({100, 60, 40}), BallMesh(50.0, 48), TubeMesh({40.0, 25.0, 120.0}, 60), PmtBox(),
          PayloadB()};
}

TEST(CutOpen, HalvesMakeUpTheWholeWhereverThePlaneIs) {
  recon::Random random(33);
  for (const core::TriangleMesh& mesh : Meshes()) {
    for (int trial = 0; trial < 24; ++trial) {
      const core::RigidTransform world_from_mesh{
          trial % 3 == 0 ? Eigen::Matrix3d::Identity() : random.Rotation(),
          random.PointIn({Vector3d::Constant(-50), Vector3d::Constant(50)})};
      const Vector3d outward =
          trial % 2 == 0 ? Vector3d::Unit(trial % 3) : Vector3d(random.Rotation() * Vector3d::UnitX());
      const Vector3d through = random.PointIn(core::BoundsOf(mesh, world_from_mesh));
      ExpectHalves(mesh, world_from_mesh, {outward, outward.dot(through)});
    }
  }
}

// Through three corners of the mesh, so that many sides lie in the plane or end on it; and along its faces.
TEST(CutOpen, HalvesMakeUpTheWholeOfPlanesThroughCornersAndAlongFaces) {
  recon::Random random(7);
  for (const core::TriangleMesh& mesh : Meshes()) {
    const auto corner = [&](std::size_t i) { return mesh.vertices_mm[i % mesh.vertices_mm.size()]; };
    for (int trial = 0; trial < 24; ++trial) {
      const core::RigidTransform world_from_mesh{
          trial % 2 == 0 ? Eigen::Matrix3d::Identity() : random.Rotation(),
          trial % 2 == 0 ? Vector3d(Vector3d::Zero())
                         : random.PointIn({Vector3d::Constant(-50), Vector3d::Constant(50)})};
      std::array<Vector3d, 3> on;
      if (trial % 4 < 2) {
        const auto& triangle = mesh.triangles[static_cast<std::size_t>(
            random.Uniform(0.0, 1.0) * static_cast<double>(mesh.triangles.size() - 1))];
        for (std::size_t i = 0; i < 3; ++i) on[i] = corner(static_cast<std::size_t>(triangle[i]));
      } else {
        for (Vector3d& x : on) x = corner(static_cast<std::size_t>(random.Uniform(0.0, 1e4)));
      }
      const Vector3d across = (on[1] - on[0]).cross(on[2] - on[0]);
      if (across.norm() < 1.0) continue;  // on a line
      const Vector3d outward = world_from_mesh.rotation * across.normalized();
      ExpectHalves(mesh, world_from_mesh, {outward, outward.dot(world_from_mesh * on[0])});
    }
  }
}

// The middle section of a cube across its diagonal is a hexagon; through three corners, a triangle.
TEST(CutOpen, ACubeCutAcrossItsDiagonalHasTheFacesOfGeometry) {
  const core::TriangleMesh cube = BoxMesh({100, 100, 100});
  const Vector3d diagonal = Vector3d::Ones().normalized();
  const core::TriangleMesh hexagon = CutOpen(cube, {}, {{{diagonal, 0.0}}}).cut_faces;
  const double hexagon_mm2 = 1.5 * std::sqrt(3.0) * 50.0 * 50.0 * 2.0;
  EXPECT_NEAR(core::AreaMm2(hexagon), hexagon_mm2, 1e-9 * hexagon_mm2);
  const CutMesh tip = CutOpen(cube, {}, {{{-diagonal, -50.0 / std::sqrt(3.0)}}});
  EXPECT_NEAR(core::VolumeMm3(Closed(tip)), 1e6 / 6.0, 1.0);
}

TEST(CutOpen, PlanesThroughCornersAndFacesCutLikeAnyOther) {
  const core::TriangleMesh box = BoxMesh({100, 60, 40});
  for (const double at_mm : {-50.0, 0.0, 50.0}) {
    const CutMesh half = CutOpen(box, {}, {{Across(0, at_mm)}});
    EXPECT_NEAR(core::VolumeMm3(Closed(half)), (at_mm + 50.0) * 60.0 * 40.0, 1e-6);
  }
}

TEST(CutOpen, FacesOfACutTubeAreARing) {
  const recon::Tube tube{40.0, 25.0, 120.0};
  const CutMesh cut_tube = CutOpen(TubeMesh(tube, 720), {}, {{Across(2, 70.0)}});
  const double ring = std::numbers::pi * (40.0 * 40.0 - 25.0 * 25.0);
  EXPECT_NEAR(core::AreaMm2(cut_tube.cut_faces), ring, 1e-4 * ring);
  for (const Vector3d& x : cut_tube.cut_faces.vertices_mm) EXPECT_NEAR(x.z(), 70.0, 1e-12);
  // Facing what was taken away.
  const auto& [a, b, c] = cut_tube.cut_faces.triangles.front();
  const auto at = [&](std::int32_t i) { return cut_tube.cut_faces.vertices_mm[static_cast<std::size_t>(i)]; };
  EXPECT_GT((at(b) - at(a)).cross(at(c) - at(a)).z(), 0.0);
}

TEST(CutOpen, ThreePlanesLeaveACorner) {
  SectionCut cut;
  for (Eigen::Index axis = 0; axis < 3; ++axis) cut.kept.push_back(Across(axis, 5.0, true));
  const CutMesh corner = CutOpen(BoxMesh({100, 60, 40}), {}, cut);
  EXPECT_NEAR(core::VolumeMm3(Closed(corner)), 45.0 * 25.0 * 15.0, 1e-6);
  EXPECT_NEAR(core::AreaMm2(corner.cut_faces), 45.0 * 25.0 + 45.0 * 15.0 + 25.0 * 15.0, 1e-6);
}

TEST(PartSections, CutsAgainOnlyWhatHasChanged) {
  PartSections sections;
  const auto mesh = std::make_shared<const core::TriangleMesh>(BoxMesh({100, 60, 40}));
  SectionCut cut;
  EXPECT_EQ(sections.Of(0, mesh, {}, cut).surface, mesh);
  cut.kept = {Across(0, 10.0)};
  const core::SharedMesh surface = sections.Of(0, mesh, {}, cut).surface;
  EXPECT_NE(surface, mesh);
  EXPECT_NE(sections.Of(0, mesh, {}, cut).cut_faces, nullptr);
  EXPECT_EQ(sections.Of(0, mesh, {}, cut).surface, surface);
  EXPECT_EQ(sections.cuts(), 1);
  cut.kept = {Across(0, 60.0)};  // beside it
  EXPECT_EQ(sections.Of(0, mesh, {}, cut).surface, mesh);
  cut.kept = {Across(0, 60.0, true)};
  EXPECT_EQ(sections.Of(0, mesh, {}, cut).surface, nullptr);
  EXPECT_EQ(sections.cuts(), 1);
}

}  // namespace
}  // namespace elbowroom::control
