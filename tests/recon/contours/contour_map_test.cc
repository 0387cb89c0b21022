#include "recon/contours/contour_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>
#include <vector>

#include "core/infinity.h"
#include "recon/contours/cell_distances.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

using core::kInfinity;
// What contour_map.h promises, in cells.
constexpr double kExactCells = 2.0;
constexpr double kExactTolerancePx = 1e-6;
constexpr double kShortCells = 3.0;
constexpr double kNearCells = 11.0;
constexpr double kShortFarCells = 11.5;
// Parity is exact but for rounding; nearer to an edge either label is right.
constexpr double kOnMapEdgePx = 1e-9;

double DistanceByHand(const Contour& contour, const Vector2d& at) {
  double nearest = kInfinity;
  for (std::uint32_t i = 0; i < contour.edges.size(); ++i)
    nearest = std::min(nearest, DistanceToEdge(contour, i, at));
  return nearest;
}

// No less than this is the label's distance where the boundary is `truth_px` away.
double PromisedPx(const ContourMap& map, const Vector2d& at, double truth_px) {
  if (map.bounds_px().isEmpty()) return kInfinity;
  const double outside_px = map.bounds_px().exteriorDistance(at);
  if (outside_px > 0.0) return std::min(outside_px, kNearCells) - kShortCells;
  if (truth_px < kExactCells) return truth_px - kExactTolerancePx;
  const double short_by = truth_px <= kNearCells ? kShortCells : kShortFarCells;
  return std::max(truth_px - short_by, kExactCells) - kExactTolerancePx;
}

void ExpectPromiseHolds(const ContourMap& map, const Vector2d& at) {
  const PlaneLabel label = map.LabelAt(at);
  const double truth_px = DistanceByHand(map.contour(), at);
  ASSERT_EQ(label.is_object, map.IsObject(at));
  if (truth_px > kOnMapEdgePx) {
    ASSERT_EQ(label.is_object, IsObjectByParity(map.contour(), map.exterior_is_object(), at))
        << at.transpose();
  }
  ASSERT_GE(label.distance_px, std::max(PromisedPx(map, at, truth_px), 0.0))
      << at.transpose() << " true distance " << truth_px;
  ASSERT_LE(label.distance_px, truth_px) << at.transpose();
  const double within_px = map.EdgeWithinPx(at);
  ASSERT_GE(within_px, truth_px) << at.transpose();
  if (!std::isinf(within_px)) {
    ASSERT_LE(within_px, truth_px + (truth_px < kNearCells - 3.0 ? 3.0 : 20.0)) << at.transpose();
  }
  const std::optional<std::uint32_t> edge = map.NearestEdge(at);
  if (truth_px < kExactCells - kExactTolerancePx) {
    ASSERT_TRUE(edge.has_value());
    ASSERT_NEAR(DistanceToEdge(map.contour(), *edge, at), truth_px, kExactTolerancePx);
  } else if (truth_px > kExactCells + kExactTolerancePx) {
    ASSERT_FALSE(edge.has_value());
  }
}

UndistortedPlane PlaneOf(int width_px, int height_px) {
  core::CameraCalibration c;
  c.image_width_px = width_px, c.image_height_px = height_px;
  c.camera_matrix << 128.0, 0.0, 0.5 * width_px, 0.0, 128.0, 0.5 * height_px, 0.0, 0.0, 1.0;
  return UndistortedPlane(core::CameraModel(c));
}

TEST(ContourMap, LabelsAndDistancesKeepTheirPromiseAgainstAllEdges) {
  Random random(5201);
  for (int trial = 0; trial < 120; ++trial) {
    const core::CameraModel camera = RandomCamera(&random, static_cast<LensKind>(trial % kLensKinds));
    const UndistortedPlane plane(camera);
    core::SoftMask silhouette{RandomMask(&random, camera.width_px(), camera.height_px()), {}};
    if (random.Chance(0.5)) silhouette = RandomLevels(&random, std::move(silhouette.mask));
    const bool exterior = random.Chance(0.5);
    const ContourMap map(TraceContour(silhouette, exterior, plane), exterior);
    const Eigen::AlignedBox2d around =
        map.bounds_px().isEmpty() ? Eigen::AlignedBox2d(Vector2d(-9, -9), Vector2d(9, 9)) : map.bounds_px();
    for (int i = 0; i < 100; ++i) {
      Vector2d at = around.center() + 0.5 * around.sizes().cwiseProduct(Vector2d(random.Uniform(-1.3, 1.3),
                                                                                 random.Uniform(-1.3, 1.3)));
      if (random.Chance(0.6) && !map.contour().edges.empty()) {
        const int edge = random.Whole(0, static_cast<int>(map.contour().edges.size()) - 1);
        at = map.contour().vertices[map.contour().edges[static_cast<std::size_t>(edge)].from] +
             random.LogUniform(1e-7, 30.0) * random.Direction().head<2>();
      }
      ExpectPromiseHolds(map, at);
    }
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

// Round numbers: positions, cell centres and edges in line, where a label asked along two legs goes wrong if
// they disagree about an edge through their common corner.
TEST(ContourMap, LabelsOfRoundPositionsAgreeWithParity) {
  Random random(5202);
  for (int trial = 0; trial < 60; ++trial) {
    const UndistortedPlane plane = PlaneOf(random.Whole(3, 12), random.Whole(3, 12));
    const core::SoftMask silhouette{
        RandomMask(&random, plane.camera().width_px(), plane.camera().height_px()), {}};
    const bool exterior = random.Chance(0.5);
    const ContourMap map(TraceContour(silhouette, exterior, plane), exterior);
    for (int y = -72; y <= 72; ++y) {
      for (int x = -72; x <= 72; ++x) {
        const Vector2d at(x / 8.0, y / 8.0);
        if (DistanceByHand(map.contour(), at) <= kOnMapEdgePx) continue;
        ASSERT_EQ(map.IsObject(at), IsObjectByParity(map.contour(), exterior, at)) << at.transpose();
      }
    }
  }
}

// Edges along a row or a column of cells, or nearly, however near to the next one: each position about them
// is in a cell that must know of them.
TEST(ContourMap, LevelAndUprightEdgesAreKnownToTheCellsOnBothSides) {
  Random random(5204);
  for (int trial = 0; trial < 200; ++trial) {
    const double right = random.Uniform(6.0, 9.0), bottom = random.Uniform(6.0, 9.0);
    const double lean = random.Chance(0.5) ? 0.0 : random.LogUniform(1e-17, 0.1);
    Contour contour;
    contour.vertices = {
        {0.0, lean},     {0.5 * right, 0.0}, {right, 0.0},        {right - lean, 0.5 * bottom},
        {right, bottom}, {0.0, bottom},      {lean, 0.5 * bottom}};
    const auto count = static_cast<std::uint32_t>(contour.vertices.size());
    for (std::uint32_t i = 0; i < count; ++i) contour.edges.push_back({i, (i + 1) % count});
    for (std::uint32_t i = 0; i < count; ++i)
      contour.edge_from.push_back(i), contour.edge_to.push_back((i + count - 1) % count);
    const ContourMap map(contour, random.Chance(0.5));
    for (int i = 0; i < 200; ++i) {
      const ContourEdge& edge = contour.edges[static_cast<std::size_t>(random.Whole(0, 6))];
      const Vector2d &from = contour.vertices[edge.from], &to = contour.vertices[edge.to];
      ExpectPromiseHolds(map, from + random.Uniform(0.0, 1.0) * (to - from) +
                                  random.LogUniform(1e-6, 0.1) * random.Direction().head<2>());
    }
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

TEST(ContourMap, LargeBoundsTakeLargerCells) {
  // Two small loops 4000 px apart along both axes: cells grow, promises hold in cells.
  Contour contour;
  for (const double corner : {-4000.0, 4000.0}) {
    const auto first = static_cast<std::uint32_t>(contour.vertices.size());
    for (const Vector2d& v : {Vector2d(0, 0), Vector2d(40, 0), Vector2d(40, 40), Vector2d(0, 40)})
      contour.vertices.push_back(v + Vector2d(corner, corner));
    for (std::uint32_t i = 0; i < 4; ++i) contour.edges.push_back({first + i, first + (i + 1) % 4});
  }
  for (std::uint32_t i = 0; i < 8; ++i) contour.edge_from.push_back(i), contour.edge_to.push_back(i);
  const ContourMap map(contour, false);
  Random random(5203);
  const double cell_px = 8040.0 / 2000.0;  // 4e6 of them
  for (int i = 0; i < 4000; ++i) {
    const Vector2d at(random.Uniform(-4300.0, 4300.0), random.Uniform(-4300.0, 4300.0));
    const PlaneLabel label = map.LabelAt(at);
    const double truth_px = DistanceByHand(contour, at);
    ASSERT_EQ(label.is_object, IsObjectByParity(contour, false, at));
    ASSERT_LE(label.distance_px, truth_px);
    ASSERT_GE(map.EdgeWithinPx(at), truth_px);
    if (map.bounds_px().contains(at)) {
      ASSERT_GE(label.distance_px, std::min(truth_px, kNearCells * cell_px) - kShortCells * cell_px);
    }
  }
}

TEST(ContourMap, FarAndHugePositionsAreExterior) {
  const UndistortedPlane plane = PlaneOf(8, 8);
  core::SoftMask silhouette{core::BitMask(8, 8), {}};
  silhouette.mask.Set(0, 0, true);
  const ContourMap map(TraceContour(silhouette, false, plane), false);
  for (const double far : {-1e300, -1e9, 1e9, 1e300}) {
    EXPECT_FALSE(map.IsObject({far, 3.0}));
    EXPECT_GT(map.LabelAt({far, 3.0}).distance_px, 1e8);
    EXPECT_FALSE(map.NearestEdge({far, 3.0}).has_value());
  }
  EXPECT_GE(map.max_radius_px(), map.bounds_px().min().norm() - 1.0);
  for (const Vector2d& v : map.contour().vertices) EXPECT_LE(v.norm(), map.max_radius_px());
}

TEST(ContourMap, IsBuiltOnceByManyThreads) {
  const UndistortedPlane plane = PlaneOf(100, 100);
  Random random(5204);
  const core::SoftMask silhouette{BlobMask(&random, 100, 100), {}};
  const ContourMap asked_by_many(TraceContour(silhouette, false, plane), false);
  const ContourMap asked_by_one(TraceContour(silhouette, false, plane), false);
  std::vector<std::thread> threads;
  std::vector<PlaneLabel> labels(4);
  for (std::size_t i = 0; i < labels.size(); ++i)
    threads.emplace_back([&, i] { labels[i] = asked_by_many.LabelAt({3.0, 4.0}); });
  for (std::thread& thread : threads) thread.join();
  for (const PlaneLabel& label : labels) {
    EXPECT_EQ(label.is_object, asked_by_one.LabelAt({3.0, 4.0}).is_object);
    EXPECT_EQ(label.distance_px, asked_by_one.LabelAt({3.0, 4.0}).distance_px);
  }
}

TEST(CellDistances, AreLowerBoundsAsShortAsPromised) {
  Random random(5205);
  for (int trial = 0; trial < 12; ++trial) {
    const int width = random.Whole(1, 130), height = random.Whole(1, 130);
    std::vector<Eigen::Vector2i> holders;
    for (int n = random.Whole(1, 6); n > 0; --n)
      holders.emplace_back(random.Whole(0, width - 1), random.Whole(0, height - 1));
    std::set<std::uint32_t> indices;
    for (const Eigen::Vector2i& holder : holders)
      indices.insert(static_cast<std::uint32_t>(holder.y() * width + holder.x()));
    const CellDistances distances(width, height, std::vector(indices.begin(), indices.end()));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double truth = kInfinity;
        for (const Eigen::Vector2i& holder : holders)
          truth = std::min(truth, std::hypot(holder.x() - x, holder.y() - y));
        const double bound = distances.LowerBound(x, y);
        ASSERT_LE(bound, truth * (1.0 + 1e-15));
        ASSERT_GE(bound, truth - (truth < CellDistances::kNearCells ? 1e-12 : 14.0 * std::sqrt(2.0)))
            << truth;
        ASSERT_GE(distances.UpperBound(x, y), truth * (1.0 - 1e-15));
        ASSERT_LE(distances.UpperBound(x, y),
                  bound * (1.0 + 1e-5) + (truth < CellDistances::kNearCells ? 0.0 : 8.5));
      }
    }
  }
}

}  // namespace
}  // namespace elbowroom::recon
