// Cut parts are closed and have the volume of what is left; kept while nothing changes.
#include <gtest/gtest.h>

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

// What is kept on both sides of a plane makes up the whole, and each side is closed: its volume doesn't
// depend on where the origin is.
void ExpectHalves(const core::TriangleMesh& mesh, const core::RigidTransform& world_from_mesh, SectionCut cut,
                  std::size_t axis) {
  const double whole = core::VolumeMm3(mesh);
  double sum = 0.0;
  for (const bool keeps_above : {false, true}) {
    cut.planes[axis]->keeps_above = keeps_above;
    CutMesh half = CutOpen(mesh, world_from_mesh, cut);
    core::TriangleMesh closed = half.surface;
    if (!half.caps.triangles.empty()) core::Append(closed, half.caps);
    if (closed.triangles.empty()) continue;
    const double volume = core::VolumeMm3(closed);
    const double elsewhere =
        core::VolumeMm3(core::Transformed(closed, {Eigen::Matrix3d::Identity(), {3e3, -2e3, 1e3}}));
    EXPECT_NEAR(elsewhere, volume, 1e-8 * (whole + 1e9));
    EXPECT_GE(volume, -1e-9 * whole);
    sum += volume;
  }
  EXPECT_NEAR(sum, whole, 1e-8 * whole);
}

TEST(CutOpen, HalvesMakeUpTheWholeWhereverThePlaneIs) {
  recon::Random random(33);
  const std::vector<core::TriangleMesh> meshes = {BoxMesh({100, 60, 40}), BallMesh(50.0, 48),
                                                  TubeMesh({40.0, 25.0, 120.0}, 60), PmtBox(), PayloadB()};
  for (const core::TriangleMesh& mesh : meshes) {
    for (int trial = 0; trial < 12; ++trial) {
      const core::RigidTransform world_from_mesh{
          trial % 3 == 0 ? Eigen::Matrix3d::Identity() : random.Rotation(),
          random.PointIn({Vector3d::Constant(-50), Vector3d::Constant(50)})};
      const Eigen::AlignedBox3d bounds = core::BoundsOf(mesh, world_from_mesh);
      const auto axis = static_cast<Eigen::Index>(trial % 3);
      SectionCut cut;
      cut.planes[static_cast<std::size_t>(axis)] =
          CutPlane{random.Uniform(bounds.min()[axis], bounds.max()[axis]), false};
      ExpectHalves(mesh, world_from_mesh, cut, static_cast<std::size_t>(axis));
    }
  }
}

TEST(CutOpen, PlanesThroughCornersAndFacesCutLikeAnyOther) {
  const core::TriangleMesh box = BoxMesh({100, 60, 40});
  for (const double at_mm : {-50.0, 0.0, 50.0}) {
    SectionCut cut;
    cut.planes[0] = CutPlane{at_mm, false};
    const CutMesh half = CutOpen(box, {}, cut);
    core::TriangleMesh closed = half.surface;
    core::Append(closed, half.caps);
    EXPECT_NEAR(core::VolumeMm3(closed), (at_mm + 50.0) * 60.0 * 40.0, 1e-6);
  }
}

TEST(CutOpen, CapsOfATubeAreARing) {
  const recon::Tube tube{40.0, 25.0, 120.0};
  SectionCut cut;
  cut.planes[2] = CutPlane{70.0, false};
  const CutMesh cut_tube = CutOpen(TubeMesh(tube, 720), {}, cut);
  const double ring = std::numbers::pi * (40.0 * 40.0 - 25.0 * 25.0);
  EXPECT_NEAR(core::AreaMm2(cut_tube.caps), ring, 1e-4 * ring);
  for (const Vector3d& x : cut_tube.caps.vertices_mm) EXPECT_NEAR(x.z(), 70.0, 1e-12);
  // Facing what was taken away.
  const auto& [a, b, c] = cut_tube.caps.triangles.front();
  const auto at = [&](std::int32_t i) { return cut_tube.caps.vertices_mm[static_cast<std::size_t>(i)]; };
  EXPECT_GT((at(b) - at(a)).cross(at(c) - at(a)).z(), 0.0);
}

TEST(CutOpen, ThreePlanesLeaveACorner) {
  SectionCut cut;
  for (auto& plane : cut.planes) plane = CutPlane{5.0, true};
  const CutMesh corner = CutOpen(BoxMesh({100, 60, 40}), {}, cut);
  core::TriangleMesh closed = corner.surface;
  core::Append(closed, corner.caps);
  EXPECT_NEAR(core::VolumeMm3(closed), 45.0 * 25.0 * 15.0, 1e-6);
  EXPECT_NEAR(core::AreaMm2(corner.caps), 45.0 * 25.0 + 45.0 * 15.0 + 25.0 * 15.0, 1e-6);
}

TEST(PartSections, CutsAgainOnlyWhatHasChanged) {
  PartSections sections;
  const auto mesh = std::make_shared<const core::TriangleMesh>(BoxMesh({100, 60, 40}));
  SectionCut cut;
  EXPECT_EQ(sections.Of(0, mesh, {}, cut).surface, mesh);
  cut.planes[0] = CutPlane{10.0, false};
  const core::SharedMesh surface = sections.Of(0, mesh, {}, cut).surface;
  EXPECT_NE(surface, mesh);
  EXPECT_NE(sections.Of(0, mesh, {}, cut).caps, nullptr);
  EXPECT_EQ(sections.Of(0, mesh, {}, cut).surface, surface);
  EXPECT_EQ(sections.cuts(), 1);
  cut.planes[0] = CutPlane{60.0, false};  // beside it
  EXPECT_EQ(sections.Of(0, mesh, {}, cut).surface, mesh);
  cut.planes[0] = CutPlane{60.0, true};
  EXPECT_EQ(sections.Of(0, mesh, {}, cut).surface, nullptr);
  EXPECT_EQ(sections.cuts(), 1);
}

}  // namespace
}  // namespace elbowroom::control
