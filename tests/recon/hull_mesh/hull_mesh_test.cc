#include "recon/hull_mesh/hull_mesh.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/carve.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/recon/scenes/vertex_fans.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kVolumeTolerance = 0.01;  // the promise: within 1 % of a 256^3 carve
constexpr double kVertexShare = 1e-3;      // of the edge: how near a vertex is to a change

std::vector<core::BitMask> FullMasks(const core::Rig& rig) {
  std::vector<core::BitMask> masks;
  for (const core::CameraModel& camera : rig.cameras) {
    core::BitMask& mask = masks.emplace_back(camera.width_px(), camera.height_px());
    for (int y = 0; y < mask.height_px(); ++y) {
      for (int x = 0; x < mask.width_px(); ++x) mask.Set(x, y, true);
    }
  }
  return masks;
}

// Whether Contains() changes within kVertexShare of an edge along one of the grid's seven directions.
bool IsAtAChange(const VisualHull& hull, const Vector3d& vertex, double edge_mm) {
  for (int code = 1; code < 8; ++code) {
    const Vector3d step = kVertexShare * edge_mm * Vector3d(code & 1, (code >> 1) & 1, code >> 2);
    if (hull.Contains(vertex - step) != hull.Contains(vertex + step)) return true;
  }
  return false;
}

TEST(MeshHull, IsAClosedManifoldWhoseVerticesSitAtChanges) {
  Random random(5001);
  int vertices = 0, astray = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const RandomScene scene =
        trial % 2 == 0
            ? MakeRandomScene(&random)
            : MakeRingScene(&random, random.Whole(1, 5),
                            random.Chance(0.5) ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    const double edge_mm = scene.rig->workspace_mm.sizes().maxCoeff() / random.Uniform(3.0, 40.0);
    const HullMesh result = MeshHull(hull, edge_mm);
    if (result.mesh.triangles.empty()) continue;
    EXPECT_TRUE(core::IsWatertight(result.mesh)) << trial;
    EXPECT_TRUE(EveryVertexHasOneFan(result.mesh)) << trial;
    EXPECT_GT(core::VolumeMm3(result.mesh), 0.0) << trial;
    for (const Vector3d& vertex : result.mesh.vertices_mm) {
      ++vertices;
      astray += IsAtAChange(hull, vertex, edge_mm) ? 0 : 1;
    }
  }
  EXPECT_GT(vertices, 20'000);
  // A silhouette of noise changes twice within the thousandth now and then; nothing else does.
  EXPECT_LE(astray, vertices / 1000);
}

TEST(MeshHull, VolumeAgreesWithACarve) {
  Random random(5002);
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    for (int trial = 0; trial < 3; ++trial) {
      const RandomScene scene = MakeRingScene(&random, 3 + trial, unseen);
      const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
      const double carved_mm3 = CarvedVolumeMm3(hull, scene.rig->workspace_mm, 128);
      const HullMesh result = MeshHull(hull, 2.5);
      EXPECT_NEAR(core::VolumeMm3(result.mesh), carved_mm3, kVolumeTolerance * carved_mm3);
    }
  }
}

TEST(MeshHull, WorkspaceFacesBecomeCaps) {
  Random random(5003);
  RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kAbstain);
  // One camera sees all of a small workspace, all object: the hull is the workspace itself.
  core::Rig rig = *scene.rig;
  rig.workspace_mm = {Vector3d(-20, -30, -25), Vector3d(25, 20, 30)};
  const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), FullMasks(rig));
  for (const double edge_mm : {1.7, 5.0, 200.0}) {
    const HullMesh result = MeshHull(hull, edge_mm);
    if (edge_mm > 100.0) {  // thinner than a cell: may be lost, but never open
      EXPECT_TRUE(result.mesh.triangles.empty() || core::IsWatertight(result.mesh));
      continue;
    }
    EXPECT_TRUE(core::IsWatertight(result.mesh));
    const Eigen::AlignedBox3d bounds = core::BoundsOf(result.mesh);
    EXPECT_LT((bounds.min() - rig.workspace_mm.min()).cwiseAbs().maxCoeff(), kVertexShare * edge_mm);
    EXPECT_LT((bounds.max() - rig.workspace_mm.max()).cwiseAbs().maxCoeff(), kVertexShare * edge_mm);
    // Edges and corners of the box are bevelled by up to a cell.
    const Vector3d sides = rig.workspace_mm.sizes();
    const double bevel_mm3 = 4.0 * sides.sum() * edge_mm * edge_mm;
    EXPECT_LE(core::VolumeMm3(result.mesh), sides.prod() * (1.0 + 1e-3));
    EXPECT_GE(core::VolumeMm3(result.mesh), sides.prod() - bevel_mm3);
  }
}

TEST(MeshHull, OneThreadMeshesWhatTwoMesh) {
  Random random(5004);
  const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const HullMesh two = MeshHull(hull, 4.0);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const HullMesh one = MeshHull(hull, 4.0);
  EXPECT_TRUE(one.mesh == two.mesh);
  EXPECT_EQ(one.cells, two.cells);
  EXPECT_EQ(one.queries, two.queries);
  EXPECT_EQ(one.skipped_cells, two.skipped_cells);
}

// At 2 mm, as the program has it; a block is a good part of a small hull at 4 mm.
TEST(MeshHull, OctreeSparesMostCellsAndMoreTheFinerTheyAre) {
  Random random(5004);
  const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const HullMesh coarse = MeshHull(hull, 4.0), fine = MeshHull(hull, 2.0);
  EXPECT_GT(fine.skipped_cells, 3 * fine.cells);
  // The surface's blocks grow by four, the workspace's by eight.
  EXPECT_LT(fine.cells, 5 * coarse.cells);
  EXPECT_GT(fine.skipped_cells, 8 * coarse.skipped_cells);
}

TEST(MeshHull, IsTheSameOnEveryTarget) {
  Random random(5008);
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    const RandomScene scene = MakeRingScene(&random, 4, unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    const HullMesh best = MeshHull(hull, 4.0);
    EXPECT_GT(best.mesh.triangles.size(), 1000U);
    int targets = 0;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
      hwy::SetSupportedTargetsForTest(left & -left);
      EXPECT_TRUE(MeshHull(hull, 4.0).mesh == best.mesh) << hwy::TargetName(left & -left);
      ++targets;
    }
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_GE(targets, 2) << "the portable one and this processor's";
  }
}

TEST(MeshHull, EmptyHullHasNoTriangles) {
  Random random(5005);
  const RandomScene scene = MakeRingScene(&random, 2, core::UnseenPolicy::kOutside);
  const std::array masks{core::BitMask(160, 120), scene.masks[1]};
  const HullMesh result = MeshHull(MakeVisualHull(scene.rig, masks), 5.0);
  EXPECT_TRUE(result.mesh.triangles.empty());
  EXPECT_EQ(result.cells, 0);
}

TEST(MeshHull, RefusesEdgesThatMakeNoGrid) {
  Random random(5006);
  const RandomScene scene = MakeRingScene(&random, 2, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  for (const double edge_mm : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e-5}) {
    try {
      (void)MeshHull(hull, edge_mm);
      ADD_FAILURE() << edge_mm;
    } catch (const core::Error& error) {
      EXPECT_EQ(error.kind(), core::ErrorKind::kRange);
    }
  }
}

TEST(MeshHull, StopsWhenAskedAndReportsInOrder) {
  Random random(5007);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  std::vector<std::int64_t> reports;  // no lock: the callback never runs twice at a time
  std::stop_source stop;
  const core::Progress progress([&](std::int64_t done, std::int64_t total, const std::string&) {
    EXPECT_LE(done, total);
    reports.push_back(done);
    if (done * 2 > total) stop.request_stop();
  });
  try {
    (void)MeshHull(hull, 4.0, progress, stop.get_token());
    ADD_FAILURE() << "not cancelled";
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::ErrorKind::kCancelled);
  }
  EXPECT_FALSE(reports.empty());
  EXPECT_TRUE(std::ranges::is_sorted(reports));
}

}  // namespace
}  // namespace elbowroom::recon
