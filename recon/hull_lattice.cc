#include "recon/hull_lattice.h"

#include <algorithm>

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr int kBisections = 40;
// Vertices keep this share of an edge away from its ends, so that no two of them fall together: in float32
// too, while the workspace is less than some 8000 edges long.
constexpr double kEndShare = 1.0 / 2048;

BlockBits AllPoints() {
  BlockBits bits;
  for (BlockBits::Layer& layer : bits.layers) {
    layer.fill(0xFF);
    layer.back() = static_cast<std::uint8_t>((1U << (BlockBits::kLayerPoints % 8)) - 1U);
  }
  return bits;
}

}  // namespace

HullLattice::HullLattice(const VisualHull& hull, const HullGrid& grid) : hull_(hull), grid_(grid) {
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const Silhouette& silhouette = *hull.silhouettes()[i];
    projections_.emplace_back(hull.rig().cameras[i], silhouette.plane().focal_px(), grid);
    rasters_.push_back(silhouette.labels().Raster());
    if (ExteriorIsObject(hull.rig())) outlines_.push_back(silhouette.plane().outline().Raster());
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
  for (const std::uint8_t i : block.cameras)
    *queries +=
        projections_[i].KeepObject(hull_.silhouettes()[i]->labels(), rasters_[i], block.corner, &bits);
  if (!block.is_seen) *queries += KeepSeen(block.corner, &bits);
  return bits;
}

BlockBits HullLattice::InWorkspace(const GridPoint& corner) const {
  BlockBits bits;
  const GridPoint first = (first_ - corner).cwiseMax(0), last = (last_ - corner).cwiseMin(kBlockCells);
  for (int z = first.z(); z <= last.z(); ++z) {
    BlockBits::Layer& layer = bits.layers[static_cast<std::size_t>(z)];
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int bit = y * kBlockPoints + first.x(); bit <= y * kBlockPoints + last.x(); ++bit) {
        std::uint8_t& byte = layer[static_cast<std::size_t>(bit / 8)];
        byte = static_cast<std::uint8_t>(byte | 1U << static_cast<unsigned>(bit % 8));
      }
    }
  }
  return bits;
}

// Under `abstain`: somebody must see a point.
std::int64_t HullLattice::KeepSeen(const GridPoint& corner, BlockBits* bits) const {
  std::int64_t queries = 0;
  BlockBits unseen = *bits;
  for (std::size_t i = 0; i < outlines_.size(); ++i) {
    BlockBits seen = unseen;
    queries +=
        projections_[i].KeepObject(hull_.silhouettes()[i]->plane().outline(), outlines_[i], corner, &seen);
    for (std::size_t z = 0; z < seen.layers.size(); ++z)
      for (std::size_t byte = 0; byte < seen.layers[z].size(); ++byte)
        unseen.layers[z][byte] = static_cast<std::uint8_t>(unseen.layers[z][byte] & ~seen.layers[z][byte]);
  }
  for (std::size_t z = 0; z < unseen.layers.size(); ++z)
    for (std::size_t byte = 0; byte < unseen.layers[z].size(); ++byte)
      bits->layers[z][byte] = static_cast<std::uint8_t>(bits->layers[z][byte] & ~unseen.layers[z][byte]);
  return queries;
}

Vector3d HullLattice::Exit(const HullBlock& block, const GridPoint& inside, const GridPoint& outside) const {
  const std::optional<double> exact = block.is_seen ? FirstExit(block, inside, outside) : std::nullopt;
  const double share = exact ? *exact : BisectedExit(inside, outside);
  const Vector3d from = grid_.At(inside);
  return from + std::clamp(share, kEndShare, 1.0 - kEndShare) * (grid_.At(outside) - from);
}

// Share of the way where the first camera sees the hull end, or the workspace does.
std::optional<double> HullLattice::FirstExit(const HullBlock& block, const GridPoint& inside,
                                             const GridPoint& outside) const {
  std::optional<double> first;
  const auto offer = [&](double share) { first = std::min(first.value_or(share), share); };
  if (!block.is_in_workspace) {
    const Eigen::AlignedBox3d& box = hull_.rig().workspace_mm;
    const Vector3d from = grid_.At(inside), to = grid_.At(outside);
    for (int axis = 0; axis < 3; ++axis) {
      const double way = to[axis] - from[axis];
      if (to[axis] > box.max()[axis]) offer((box.max()[axis] - from[axis]) / way);
      if (to[axis] < box.min()[axis]) offer((box.min()[axis] - from[axis]) / way);
    }
  }
  for (const std::uint8_t i : block.cameras) {
    const PointProjection::Point from = projections_[i].Of(inside), to = projections_[i].Of(outside);
    if (!(from.z_mm > 0.0) || !(to.z_mm > 0.0)) return std::nullopt;
    const std::optional<double> in_picture =
        hull_.silhouettes()[i]->labels().FirstCrossing(from.position, to.position);
    // From a share of the way in the picture to one of the way in space.
    if (in_picture) offer(*in_picture * from.z_mm / (to.z_mm + *in_picture * (from.z_mm - to.z_mm)));
  }
  return first;
}

double HullLattice::BisectedExit(const GridPoint& inside, const GridPoint& outside) const {
  const Vector3d from = grid_.At(inside), to = grid_.At(outside);
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (hull_.Contains(from + middle * (to - from)) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace elbowroom::recon
