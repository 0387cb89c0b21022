#include "review/point_spread.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"

namespace elbowroom::review {
namespace {

using Row = SpreadBlock::Row;

constexpr auto kPoints = static_cast<std::size_t>(SpreadBlock::kPoints);
constexpr float kInfinite = std::numeric_limits<float>::infinity();
// More than single precision loses in comparing a block with a point, as a share.
constexpr float kSlack = 1e-5F;

// Single precision relative to the first point is enough: it only decides which of two points is farther.
Eigen::Vector3f PositionOf(std::span<const core::ContactPoint> points, std::size_t i) {
  return (points[i].position_in_world_mm - points[0].position_in_world_mm).cast<float>();
}

Row SquaredDistances(const SpreadBlock& block, const Eigen::Vector3f& x) {
  return (block.at[0] - x[0]).square() + (block.at[1] - x[1]).square() + (block.at[2] - x[2]).square();
}

// The last block is filled up with copies of the last point that are never the farthest.
void FillBlocks(std::span<const core::ContactPoint> points, std::vector<SpreadBlock>* blocks) {
  blocks->resize((points.size() + kPoints - 1) / kPoints);
  for (std::size_t b = 0; b < blocks->size(); ++b) {
    SpreadBlock& block = (*blocks)[b];
    for (std::size_t k = 0; k < kPoints; ++k) {
      const std::size_t i = b * kPoints + k;
      const Eigen::Vector3f at = PositionOf(points, std::min(i, points.size() - 1));
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        block.at[static_cast<std::size_t>(axis)][static_cast<Eigen::Index>(k)] = at[axis];
      block.nearest[static_cast<Eigen::Index>(k)] = i < points.size() ? kInfinite : 0.0F;
    }
    block.nearest_kept.setZero();
    for (std::size_t axis = 0; axis < 3; ++axis)
      block.center[axis] = 0.5F * (block.at[axis].minCoeff() + block.at[axis].maxCoeff());
    block.radius = std::sqrt(SquaredDistances(block, Eigen::Vector3f(block.center.data())).maxCoeff());
    block.farthest = block.reach = kInfinite;
  }
}

void Keep(const Eigen::Vector3f& x, float number, SpreadBlock* block) {
  if ((x - Eigen::Vector3f(block->center.data())).squaredNorm() > block->reach) return;
  const Row squared = SquaredDistances(*block, x);
  block->nearest_kept = (squared < block->nearest).select(Row::Constant(number), block->nearest_kept);
  block->nearest = block->nearest.min(squared);
  block->farthest = block->nearest.maxCoeff();
  const float reach = (std::sqrt(block->farthest) + block->radius) * (1.0F + kSlack);
  block->reach = reach * reach;
}

// The point that is farthest from all that are kept; the first of several.
std::size_t Farthest(std::span<const SpreadBlock> blocks) {
  const auto block = std::ranges::max_element(blocks, {}, &SpreadBlock::farthest);
  const auto in_block = std::find(block->nearest.begin(), block->nearest.end(), block->farthest);
  return static_cast<std::size_t>(block - blocks.begin()) * kPoints +
         static_cast<std::size_t>(in_block - block->nearest.begin());
}

}  // namespace

std::vector<core::ContactPoint> SpreadEvenly(std::span<const core::ContactPoint> points, std::size_t count) {
  SpreadScratch own;
  return SpreadEvenly(points, count, &own);
}

std::vector<core::ContactPoint> SpreadEvenly(std::span<const core::ContactPoint> points, std::size_t count,
                                             SpreadScratch* scratch) {
  core::Require(count > 0, "at least one point is kept");
  std::vector<core::ContactPoint> kept = std::move(scratch->kept);
  if (points.size() <= count) {
    kept.assign(points.begin(), points.end());
    return kept;
  }
  kept.clear();
  FillBlocks(points, &scratch->blocks);
  std::size_t next = 0;
  while (kept.size() < count) {
    for (SpreadBlock& block : scratch->blocks)
      Keep(PositionOf(points, next), static_cast<float>(kept.size()), &block);
    kept.push_back(points[next]);
    kept.back().area_mm2 = 0.0;
    next = Farthest(scratch->blocks);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SpreadBlock& block = scratch->blocks[i / kPoints];
    const float nearest = block.nearest_kept[static_cast<Eigen::Index>(i % kPoints)];
    kept[static_cast<std::size_t>(nearest)].area_mm2 += points[i].area_mm2;
  }
  return kept;
}

}  // namespace elbowroom::review
