#include "recon/contours/contour_kernel.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "recon/contours/contour_map.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/label_kernel.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The kernel's double against long double: where a way is crossed, in px along it.
constexpr double kCrossingTolerancePx = 1e-6;
// Parity is exact but for rounding; nearer to an edge either label is right.
constexpr double kOnEdgePx = 1e-9;

// Beside one of the contour's vertices, a step being a part of a pixel to a few.
GridView RandomView(Random* random, const ContourMap& map, bool crosses_camera_plane) {
  const std::vector<Vector2d>& vertices = map.contour().vertices;
  const auto vertex = static_cast<std::size_t>(random->Whole(0, static_cast<int>(vertices.size()) - 1));
  const double z_mm = random->LogUniform(1.0, 1e4), step_px = random->LogUniform(0.05, 4.0);
  const double depth_share = crosses_camera_plane ? 0.3 : 0.01;
  GridView view;
  const Vector2d beside(random->Uniform(-2.0, 2.0), random->Uniform(-2.0, 2.0));
  view.origin = {z_mm * (vertices[vertex] + beside).x(), z_mm * (vertices[vertex] + beside).y(), z_mm};
  for (std::array<double, 3>& step : view.steps) {
    const double step_z = z_mm * random->Uniform(-depth_share, depth_share);
    step = {z_mm * random->Uniform(-step_px, step_px), z_mm * random->Uniform(-step_px, step_px), step_z};
  }
  return view;
}

Vector3d InCam(const GridView& view, const GridPoints& points, std::size_t i) {
  Vector3d in_cam;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto row = static_cast<std::size_t>(k);
    in_cam[k] = (points.at[0][i] * view.steps[0][row] + points.at[1][i] * view.steps[1][row]) +
                (view.origin[row] + points.at[2][i] * view.steps[2][row]);
  }
  return in_cam;
}

// As many points as there is room for, and one step on from each.
struct RandomWays {
  GridPoints from, to;

  explicit RandomWays(Random* random) {
    from.count = to.count = static_cast<std::size_t>(random->Whole(1, GridPoints::kMost));
    for (std::size_t i = 0; i < from.count; ++i) {
      const auto along = static_cast<std::size_t>(random->Whole(0, 2));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        from.at[axis][i] = to.at[axis][i] = random->Whole(0, 8);
        if (axis == along) to.at[axis][i] += random->Chance(0.5) ? 1.0 : -1.0;
      }
    }
  }
};

using Exact = long double;

// Of all edges of the contour, one by one; kNoCrossing if none is met.
Exact FirstShareByHand(const Contour& contour, const Vector2d& from, const Vector2d& to) {
  const Exact way_x = Exact{to.x()} - from.x(), way_y = Exact{to.y()} - from.y();
  Exact nearest = kNoCrossing;
  for (const ContourEdge& edge : contour.edges) {
    const Vector2d &a = contour.vertices[edge.from], &b = contour.vertices[edge.to];
    const Exact along_x = Exact{b.x()} - a.x(), along_y = Exact{b.y()} - a.y();
    const Exact to_a_x = Exact{a.x()} - from.x(), to_a_y = Exact{a.y()} - from.y();
    const Exact across = way_x * along_y - way_y * along_x;
    const Exact share = (to_a_x * along_y - to_a_y * along_x) / across;
    const Exact edge_share = (to_a_x * way_y - to_a_y * way_x) / across;
    if (share >= 0 && share <= 1 && edge_share >= 0 && edge_share <= 1) nearest = std::min(nearest, share);
  }
  return nearest;
}

struct Count {
  int crossed = 0, missed = 0, returned = 0, unknown = 0;
};

void CompareWay(const ContourMap& map, const Vector3d& from, const Vector3d& to, double share, Count* count) {
  if (!(from.z() > 0.0) || !(to.z() > 0.0)) {
    ASSERT_EQ(share, kUnknownCrossing);
    ++count->unknown;
    return;
  }
  const Vector2d p = from.head<2>() / from.z(), q = to.head<2>() / to.z();
  const Exact in_picture = FirstShareByHand(map.contour(), p, q);
  if (in_picture > 1) {
    ASSERT_EQ(share, kNoCrossing) << p.transpose() << " to " << q.transpose();
    ++count->missed;
    return;
  }
  ++count->crossed;
  const Exact in_space = in_picture * from.z() / (to.z() + in_picture * (Exact{from.z()} - to.z()));
  ASSERT_NEAR(share, static_cast<double>(in_space), kCrossingTolerancePx / (q - p).norm());
  if (map.IsObject(p) == map.IsObject(q)) ++count->returned;
}

// Any silhouette, any lens; calls run(map) for those with edges.
template <typename Run>
void ForRandomContours(std::uint64_t seed, int scenes, const Run& run) {
  Random random(seed);
  for (int trial = 0; trial < scenes; ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (const auto& silhouette : hull.silhouettes()) {
      if (!silhouette->labels().bounds_px().isEmpty()) run(&random, silhouette->labels());
    }
  }
}

TEST(ContourKernel, OffersTheFirstCrossingOfAllEdges) {
  Count count;
  ForRandomContours(6101, 40, [&](Random* random, const ContourMap& map) {
    for (int trial = 0; trial < 16; ++trial) {
      const GridView view = RandomView(random, map, random->Chance(0.1));
      const RandomWays ways(random);
      WayShares shares;
      shares.at.fill(kNoCrossing);
      LowerToCrossings(view, map.CellsView(), ways.from, ways.to, &shares);
      for (std::size_t i = 0; i < ways.from.count; ++i) {
        CompareWay(map, InCam(view, ways.from, i), InCam(view, ways.to, i), shares.at[i], &count);
        if (testing::Test::HasFatalFailure()) return;
      }
      // What is nearer stays; what is farther goes.
      WayShares lower = shares;
      for (double& share : lower.at) share -= 1e-3;
      const WayShares before = lower;
      LowerToCrossings(view, map.CellsView(), ways.from, ways.to, &lower);
      for (std::size_t i = 0; i < ways.from.count; ++i)
        ASSERT_EQ(lower.at[i], shares.at[i] == kUnknownCrossing ? kUnknownCrossing : before.at[i]);
    }
  });
  EXPECT_GT(count.crossed, 2000);
  EXPECT_GT(count.missed, 2000);
  EXPECT_GT(count.unknown, 20);
  EXPECT_GT(count.returned, 100) << "ways that leave the silhouette and come back";
}

TEST(ContourKernel, LabelsPointsAsTheContourDoes) {
  int object = 0, background = 0;
  ForRandomContours(6102, 40, [&](Random* random, const ContourMap& map) {
    const GridView view = RandomView(random, map, random->Chance(0.2));
    const GridPoints points = RandomWays(random).from;
    const std::uint64_t labels = LabelPoints(view, map.CellsView(), points);
    for (std::size_t i = 0; i < points.count; ++i) {
      const Vector3d in_cam = InCam(view, points, i);
      bool expected = map.exterior_is_object();
      if (in_cam.z() > 0.0) {
        const Vector2d at = in_cam.head<2>() / in_cam.z();
        const std::optional<std::uint32_t> edge = map.NearestEdge(at);
        if (edge && DistanceToEdge(map.contour(), *edge, at) < kOnEdgePx) continue;
        expected = IsObjectByParity(map.contour(), map.exterior_is_object(), at);
      }
      ASSERT_EQ((labels >> i & 1U) != 0, expected) << in_cam.transpose();
      ++(expected ? object : background);
    }
    if (points.count < GridPoints::kMost) {
      EXPECT_EQ(labels >> points.count, 0U);
    }
  });
  EXPECT_GT(object, 500);
  EXPECT_GT(background, 500);
}

GridPoints OneGroup(std::size_t group, const GridPoint& corner) {
  GridPoints points;
  points.count = 8;
  for (std::size_t i = 0; i < points.count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points.at[axis][i] = corner[static_cast<Eigen::Index>(axis)] + BlockBits::kPoints[8 * group + i][axis];
    }
  }
  return points;
}

// What BlockInCells counts on.
TEST(ContourKernel, CellsAreMixedIfAnEdgeIsNearlyInThem) {
  int looked_at = 0;
  ForRandomContours(6105, 20, [&](Random* random, const ContourMap& map) {
    const ContourCellsView cells = map.CellsView();
    constexpr double kOff = 0.999 * ContourCellsView::kTouchCells;  // less the rounding of the position here
    for (const ContourEdge& edge : map.contour().edges) {
      const Vector2d &a = map.contour().vertices[edge.from], &b = map.contour().vertices[edge.to];
      const Vector2d off(random->Uniform(-kOff, kOff), random->Uniform(-kOff, kOff));
      const Vector2d origin_px(cells.origin_x_px, cells.origin_y_px);
      const Vector2d at = (a + random->Uniform(0.0, 1.0) * (b - a) - origin_px) * cells.cells_per_px + off;
      const auto cell = static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(cells.width) +
                        static_cast<std::size_t>(at.x());
      ASSERT_NE(cells.labels[cell] & ContourCellsView::kMixed, 0) << at.transpose();
      ASSERT_EQ(cells.clear_squares[cell], 0);
      ++looked_at;
    }
  });
  EXPECT_GT(looked_at, 10'000);
}

// In float32, but what it is sure of is so.
TEST(ContourKernel, CellsThatAreSureAreRight) {
  int sure = 0, mixed_points = 0, blocks_left = 0, blocks_by_bars = 0;
  ForRandomContours(6103, 60, [&](Random* random, const ContourMap& map) {
    GridView view = RandomView(random, map, random->Chance(0.1));
    // A block far from the grid's origin, at the same place in the picture.
    const GridPoint corner(random->Whole(0, 1000), random->Whole(0, 1000), random->Whole(0, 1000));
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        view.origin[k] -= corner[static_cast<Eigen::Index>(axis)] * view.steps[axis][k];
    BlockBits bits, mixed;
    bits.groups.fill(0xFF);
    bits.groups.back() = 1;  // the far face's last point
    const BlockBits all = bits;
    const ContourCellsView cells = map.CellsView();
    BlockInCells block(view, corner, cells);
    block.LabelBars(&bits);
    blocks_by_bars += block.LabelRows(&bits, &mixed) < 8 * BlockBits::kGroups ? 1 : 0;
    blocks_left += mixed.groups == all.groups ? 1 : 0;
    for (std::size_t group = 0; group < BlockBits::kGroups; ++group) {
      const auto exact =
          static_cast<std::uint8_t>(all.groups[group] & LabelPoints(view, cells, OneGroup(group, corner)));
      const unsigned unsure = mixed.groups[group];
      ASSERT_EQ(bits.groups[group] & ~unsure, exact & ~unsure) << "group " << group;
      ASSERT_EQ(bits.groups[group] & unsure, unsure);
      mixed_points += std::popcount(unsure);
      sure += std::popcount(all.groups[group] & ~unsure);
    }
  });
  EXPECT_GT(sure, 10'000);
  EXPECT_GT(mixed_points, 10'000);
  EXPECT_GT(blocks_left, 2) << "blocks that float32 doesn't do";
  EXPECT_GT(blocks_by_bars, 10) << "blocks with bars that no edge reaches";
}

TEST(ContourKernel, GivesTheSameBitsOnEveryTarget) {
  int targets = 0;
  ForRandomContours(6104, 20, [&](Random* random, const ContourMap& map) {
    const GridView view = RandomView(random, map, random->Chance(0.2));
    const RandomWays ways(random);
    WayShares best;
    best.at.fill(kNoCrossing);
    LowerToCrossings(view, map.CellsView(), ways.from, ways.to, &best);
    const std::uint64_t labels = LabelPoints(view, map.CellsView(), ways.from);
    targets = 0;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
      hwy::SetSupportedTargetsForTest(left & -left);
      WayShares shares;
      shares.at.fill(kNoCrossing);
      LowerToCrossings(view, map.CellsView(), ways.from, ways.to, &shares);
      EXPECT_TRUE(std::equal(best.at.begin(), best.at.begin() + ways.from.count, shares.at.begin()));
      EXPECT_EQ(LabelPoints(view, map.CellsView(), ways.from), labels);
      ++targets;
    }
    hwy::SetSupportedTargetsForTest(0);
  });
  EXPECT_GE(targets, 2) << "the portable one and this processor's";
}

}  // namespace
}  // namespace elbowroom::recon
