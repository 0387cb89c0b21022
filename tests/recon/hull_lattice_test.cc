#include "recon/hull_lattice.h"

#include <gtest/gtest.h>

#include "tests/recon/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// Positions are worked out along the grid, not point by point: a label may differ this near to a change, as a
// share of the grid's edge.
constexpr double kRoundingShare = 1e-7;

bool IsAtAChange(const VisualHull& hull, const Vector3d& x, double edge_mm) {
  const bool label = hull.Contains(x);
  for (int code = 0; code < 27; ++code) {
    const Vector3d way(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
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
        if (is_inside != hull.Contains(point) && !IsAtAChange(hull, point, grid.edge_mm)) ++count->wrong;
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

}  // namespace
}  // namespace elbowroom::recon
