#include "recon/hull_mesh/hull_lattice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr int kBisections = 40;
// Vertices keep this share of an edge away from its ends, so that no two of them fall together. That holds in
// float32, too, while the workspace is less than some 8000 edges long.
constexpr double kEndShare = 1.0 / 2048;

GridPoint LowEnd(const HullBlock& block, const BlockEdge& edge) {
  return block.corner + GridPoint(edge.low[0], edge.low[1], edge.low[2]);
}

// Sets point i of `from` to the edge's end inside, and point i of `to` to its end outside.
void SetEnds(const HullBlock& block, const BlockEdge& edge, std::size_t i, GridPoints* from, GridPoints* to) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    from->at[axis][i] = to->at[axis][i] = block.corner[static_cast<Eigen::Index>(axis)] + edge.low[axis];
  (edge.low_is_inside ? to : from)->at[edge.axis][i] += 1.0;
}

Vector3d PointOf(const GridPoints& points, std::size_t i) {
  return {points.at[0][i], points.at[1][i], points.at[2][i]};
}

BlockBits AllPoints() {
  BlockBits bits;
  bits.groups.fill(0xFF);
  bits.groups.back() = static_cast<std::uint8_t>((1U << (BlockBits::kRows % 8)) - 1U);
  return bits;
}

void Clear(const BlockBits& others, BlockBits* bits) {
  for (std::size_t i = 0; i < bits->groups.size(); ++i)
    bits->groups[i] = static_cast<std::uint8_t>(bits->groups[i] & ~others.groups[i]);
}

}  // namespace

HullLattice::HullLattice(const VisualHull& hull, const HullGrid& grid) : hull_(hull), grid_(grid) {
  hull.Prepare();
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const Silhouette& silhouette = *hull.silhouettes()[i];
    views_.push_back(ViewGrid(hull.rig().cameras[i], silhouette.plane().focal_px(), grid));
    cells_.push_back(silhouette.labels().CellsView());
    if (ExteriorIsObject(hull.rig())) outlines_.push_back(silhouette.plane().outline().CellsView());
  }
  first_.setZero(), last_ = grid.cells;
  const Eigen::AlignedBox3d& box = hull.rig().workspace_mm;
  for (int axis = 0; axis < 3; ++axis) {
    while (first_[axis] <= last_[axis] && grid.At(first_)[axis] < box.min()[axis]) ++first_[axis];
    while (first_[axis] <= last_[axis] && grid.At(last_)[axis] > box.max()[axis]) --last_[axis];
  }
}

BlockBits HullLattice::LabelsOf(const HullBlock& block, std::int64_t* queries) const {
  BlockBits bits = block.is_in_workspace ? AllPoints() : InWorkspace(block.corner);
  // First by bars, then by cells, each for all cameras: most points in mixed cells of one camera are outside
  // to another.
  std::vector<BlockInCells> in_cells;
  in_cells.reserve(block.cameras.size());
  for (const std::uint8_t camera : block.cameras) {
    in_cells.emplace_back(views_[camera], block.corner, cells_[camera]);
    *queries += static_cast<std::int64_t>(in_cells.back().LabelBars(&bits));
  }
  std::vector<BlockBits> mixed(block.cameras.size());
  for (std::size_t i = 0; i < mixed.size(); ++i)
    *queries += static_cast<std::int64_t>(in_cells[i].LabelRows(&bits, &mixed[i]));
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    const std::uint8_t camera = block.cameras[i];
    SettleMixed(views_[camera], cells_[camera], block.corner, mixed[i], &bits);
  }
  if (!block.is_seen) *queries += KeepSeen(block.corner, &bits);
  return bits;
}

BlockBits HullLattice::InWorkspace(const GridPoint& corner) const {
  BlockBits bits;
  const GridPoint first = (first_ - corner).cwiseMax(0), last = (last_ - corner).cwiseMin(kBlockCells);
  unsigned row = 0;
  for (int x = first.x(); x <= last.x(); ++x) row |= 1U << static_cast<unsigned>(x);
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      const auto i = static_cast<std::size_t>(y + kBlockPoints * z);
      std::uint8_t& far = bits.groups[BlockBits::kRows + i / 8];
      bits.groups[i] = static_cast<std::uint8_t>(row);
      far = static_cast<std::uint8_t>(far | (row >> 8U) << (i % 8));
    }
  }
  return bits;
}

// Under `abstain`: clears the points that no camera sees. Returns the number of labels asked.
std::int64_t HullLattice::KeepSeen(const GridPoint& corner, BlockBits* bits) const {
  std::int64_t queries = 0;
  BlockBits unseen = *bits;
  for (std::size_t i = 0; i < outlines_.size(); ++i) {
    BlockBits seen = unseen, mixed;
    BlockInCells in_cells(views_[i], corner, outlines_[i]);
    queries += static_cast<std::int64_t>(in_cells.LabelBars(&seen));
    queries += static_cast<std::int64_t>(in_cells.LabelRows(&seen, &mixed));
    SettleMixed(views_[i], outlines_[i], corner, mixed, &seen);
    Clear(seen, &unseen);
  }
  Clear(unseen, bits);
  return queries;
}

void HullLattice::FindExits(const HullBlock& block, std::span<const BlockEdge> edges,
                            std::span<Vector3d> exits_in_world) const {
  WayShares all_shares;
  GridPoints from, to;
  for (; !edges.empty();
       exits_in_world = exits_in_world.subspan(from.count), edges = edges.subspan(from.count)) {
    from.count = to.count = std::min(edges.size(), GridPoints::kMost);
    for (std::size_t i = 0; i < from.count; ++i) SetEnds(block, edges[i], i, &from, &to);
    const std::span shares(all_shares.at.data(), from.count);
    std::ranges::fill(shares, block.is_seen ? kNoCrossing : kUnknownCrossing);
    if (!block.is_in_workspace) OfferFaces(block, edges.first(from.count), shares);
    for (const std::uint8_t i : block.cameras) LowerToCrossings(views_[i], cells_[i], from, to, &all_shares);
    for (std::size_t i = 0; i < from.count; ++i) {
      const Vector3d inside = grid_.AtSteps(PointOf(from, i)), outside = grid_.AtSteps(PointOf(to, i));
      const bool is_exact = shares[i] >= 0.0 && shares[i] <= 1.0;
      const double share =
          std::clamp(is_exact ? shares[i] : BisectedExit(inside, outside), kEndShare, 1.0 - kEndShare);
      // The other coordinates are those of both ends.
      const int axis = edges[i].axis;
      exits_in_world[i] = inside;
      exits_in_world[i][axis] += share * (outside[axis] - inside[axis]);
    }
  }
}

void HullLattice::OfferFaces(const HullBlock& block, std::span<const BlockEdge> edges,
                             std::span<double> shares) const {
  const Eigen::AlignedBox3d& box = hull_.rig().workspace_mm;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int axis = edges[i].axis;
    const GridPoint low = LowEnd(block, edges[i]);
    const double ends[2] = {grid_.At(low)[axis], grid_.At(low + GridPoint::Unit(axis))[axis]};
    const double inside = ends[edges[i].low_is_inside ? 0 : 1],
                 outside = ends[edges[i].low_is_inside ? 1 : 0];
    const double face = std::clamp(outside, box.min()[axis], box.max()[axis]);
    if (face != outside) shares[i] = std::min(shares[i], (face - inside) / (outside - inside));
  }
}

double HullLattice::BisectedExit(const Vector3d& inside, const Vector3d& outside) const {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (hull_.Contains(inside + middle * (outside - inside)) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace elbowroom::recon
