#include "recon/hull_mesh/hull_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/block_surface.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// Positions are worked out along the grid, not point by point: a label may differ this near to a change, as a
// share of the grid's edge.
constexpr double kRoundingShare = 1e-7;
// Two ways to the same crossing, as a share of the grid's edge.
constexpr double kExitShare = 1e-6;
// What hull_lattice.h promises.
constexpr double kEndShare = 1.0 / 2048;

bool IsBesideAChange(const VisualHull& hull, const Vector3d& x, double edge_mm) {
  const bool label = hull.Contains(x);
  for (int code = 0; code < 27; ++code) {
    const int x_way = code % 3 - 1, y_way = code / 3 % 3 - 1, z_way = code / 9 - 1;
    const Vector3d way(x_way, y_way, z_way);
    if (hull.Contains(x + kRoundingShare * edge_mm * way) != label) return true;
  }
  return false;
}

struct Count {
  int points = 0;
  int inside = 0;
  int wrong = 0;
};

void CompareBlock(const VisualHull& hull, const HullGrid& grid, const HullBlock& block,
                  const HullLattice& lattice, Count* count) {
  std::int64_t queries = 0;
  const BlockBits labels = lattice.LabelsOf(block, &queries);
  for (int z = 0; z < kBlockPoints; ++z) {
    for (int y = 0; y < kBlockPoints; ++y) {
      for (int x = 0; x < kBlockPoints; ++x) {
        const Vector3d point = grid.At(block.corner + GridPoint(x, y, z));
        const bool is_inside = labels.At(x, y, z);
        ++count->points;
        count->inside += is_inside ? 1 : 0;
        if (is_inside != hull.Contains(point) && !IsBesideAChange(hull, point, grid.edge_mm)) ++count->wrong;
      }
    }
  }
}

// Of any lens and policy, cameras amid the workspace, silhouettes of noise, points behind cameras.
TEST(HullLattice, LabelsWhatTheHullContains) {
  Random random(5101);
  Count count;
  for (int trial = 0; trial < 60 * test_support::SoakScale(); ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    if (hull.IsEmpty()) continue;
    const double edge_mm = scene.rig->workspace_mm.sizes().maxCoeff() / random.Uniform(3.0, 60.0);
    const HullGrid grid = MakeHullGrid(scene.rig->workspace_mm, edge_mm);
    const HullLattice lattice(hull, grid);
    const HullBlocks found = FindHullBlocks(hull, grid, {}, {});
    for (std::size_t i = 0; i < found.blocks.size(); i += 1 + found.blocks.size() / 8)
      CompareBlock(hull, grid, found.blocks[i], lattice, &count);
  }
  EXPECT_GT(count.points, 50'000);
  EXPECT_GT(count.inside, count.points / 50);
  EXPECT_EQ(count.wrong, 0);
}

// How far from one end of an edge to the other the hull is first left: all edges of all contours, one by one.
// Nothing where an end isn't in front of every camera.
std::optional<double> ExitByHand(const VisualHull& hull, const Vector3d& inside, const Vector3d& outside) {
  double exit = kNoCrossing;
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const core::RigidTransform& cam_from_world = hull.rig().cameras[i].cam_from_world();
    const Vector3d from = cam_from_world * inside, to = cam_from_world * outside;
    if (!(from.z() > 0.0 && to.z() > 0.0)) return std::nullopt;
    const double focal_px = hull.silhouettes()[i]->plane().focal_px();
    const Contour& contour = hull.silhouettes()[i]->labels().contour();
    for (const ContourEdge& edge : contour.edges) {
      const Eigen::Vector2d &a = contour.vertices[edge.from], &b = contour.vertices[edge.to];
      // The plane through the edge and the camera's centre, in space.
      const Vector3d n = Vector3d(a.x(), a.y(), focal_px).cross(Vector3d(b.x(), b.y(), focal_px));
      const double share = n.dot(from) / (n.dot(from) - n.dot(to));
      if (!(share >= 0.0 && share <= 1.0)) continue;
      const Vector3d at = from + share * (to - from);
      const Eigen::Vector2d along = b - a, to_at = at.head<2>() * (focal_px / at.z()) - a;
      const double edge_share = along.dot(to_at) / along.squaredNorm();
      if (edge_share >= 0.0 && edge_share <= 1.0) exit = std::min(exit, share);
    }
  }
  return exit;
}

// Also of edges whose picture leaves a silhouette and comes back to it.
TEST(HullLattice, VerticesStandWhereTheHullIsFirstLeft) {
  Random random(5102);
  int vertices = 0, wrong = 0;
  for (int trial = 0; trial < 60 * test_support::SoakScale(); ++trial) {
    const RandomScene scene = trial % 2 == 0
                                  ? MakeRandomScene(&random)
                                  : MakeRingScene(&random, random.Whole(1, 5), core::UnseenPolicy::kOutside);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    if (hull.IsEmpty() || ExteriorIsObject(hull.rig())) continue;
    const double edge_mm = scene.rig->workspace_mm.sizes().maxCoeff() / random.Uniform(3.0, 60.0);
    const HullGrid grid = MakeHullGrid(scene.rig->workspace_mm, edge_mm);
    const HullLattice lattice(hull, grid);
    const HullBlocks found = FindHullBlocks(hull, grid, {}, {});
    for (std::size_t i = 0; i < found.blocks.size(); i += 1 + found.blocks.size() / 40) {
      const HullBlock& block = found.blocks[i];
      if (!block.is_in_workspace) continue;
      const BlockSurface surface = CutBlock(lattice, block);
      for (std::size_t e = 0; e < surface.edges.size(); ++e) {
        const auto [x, y, z] = surface.edges[e].low;
        const GridPoint low = block.corner + GridPoint(x, y, z);
        Vector3d inside = grid.At(low), outside = grid.At(low + GridPoint::Unit(surface.edges[e].axis));
        if (!surface.edges[e].low_is_inside) std::swap(inside, outside);
        const std::optional<double> exit = ExitByHand(hull, inside, outside);
        if (!exit) continue;
        const double share = (surface.vertices_in_world[e] - inside).norm() / edge_mm;
        ++vertices;
        wrong += std::abs(share - std::clamp(*exit, kEndShare, 1.0 - kEndShare)) > kExitShare ? 1 : 0;
      }
    }
  }
  EXPECT_GT(vertices, 5000);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace elbowroom::recon
