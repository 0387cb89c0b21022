#include "recon/swept_volume/swept_tile.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::recon {
namespace {

// By level: the number of nodes of all finer levels.
constexpr std::array<std::size_t, 6> kFirstNode = {0, 4096, 4608, 4672, 4680, 4681};

}  // namespace

std::size_t SweptTile::NodeIndex(int level, int x, int y, int z) {
  const int side = kTileCells >> level;
  return kFirstNode[static_cast<std::size_t>(level)] + static_cast<std::size_t>(x + side * (y + side * z));
}

SweptTile::SweptTile(const SweptGrid& grid, const GridCell& first)
    : grid_(&grid),
      first_(first),
      options_{grid.rounding_mm, grid.LeastMm()},
      below_(static_cast<float>(-grid.LeastMm())),
      values_(kTileCorners * kTileCorners * kTileCorners, Unset(grid)),
      seconds_(kFirstNode[kLevels], 0.0),
      buried_(kFirstNode[kLevels], false) {}

std::int64_t SweptTile::Bytes() {
  return static_cast<std::int64_t>(sizeof(SweptTile) +
                                   sizeof(float) * kTileCorners * kTileCorners * kTileCorners +
                                   (sizeof(double) + 1) * kFirstNode[kLevels]);
}

double SweptTile::Seconds(int x, int y, int z) const {
  if (seconds_.empty()) return 0.0;
  double seconds = 0.0;
  for (int level = 0; level < kLevels; ++level)
    seconds += seconds_[NodeIndex(level, x >> level, y >> level, z >> level)];
  return seconds;
}

// One hull's way down the tile's octree.
struct SweptTile::Visitor {
  SweptTile& tile;
  const VisualHull& hull;
  double seconds;
  SweptWork* work;

  void Visit(int level, const GridCell& node, UndecidedCameras open) {
    const GridCell low = node * (1 << level);
    if (((tile.first_ + low).array() >= tile.grid_->cells.array()).any()) return;
    const std::size_t index = NodeIndex(level, node.x(), node.y(), node.z());
    if (tile.buried_[index]) {
      work->buried_cells += std::int64_t{1} << (3 * level);
      return;
    }
    const double sides = 1 << level;
    const Eigen::Vector3d center = tile.grid_->At(tile.first_ + low) + 0.5 * sides * tile.grid_->cell_mm;
    const double radius_mm = 0.5 * sides * tile.grid_->DiagonalMm() * (1.0 + 1e-9) + tile.grid_->rounding_mm;
    ++work->balls;
    const BallAnswer answer = hull.Classify(center, radius_mm, &open);
    if (answer == BallAnswer::kOutside) return;
    if (answer == BallAnswer::kMixed && level > 0) {
      for (int child = 0; child < 8; ++child)
        Visit(level - 1, 2 * node + GridCell(child & 1, (child >> 1) & 1, child >> 2), open);
      return;
    }
    tile.seconds_[index] += seconds;
    if (answer == BallAnswer::kInside) {
      tile.CoverNode(level, node);
    } else {
      tile.BoundCell(node, hull, open, work);
    }
  }
};

void SweptTile::Add(const VisualHull& hull, const UndecidedCameras& open, double seconds, SweptWork* work) {
  if (is_buried()) {
    work->buried_cells += kTileCells * kTileCells * kTileCells;
    return;
  }
  Visitor{*this, hull, seconds, work}.Visit(kLevels - 1, GridCell::Zero(), open);
}

void SweptTile::Lower(int x, int y, int z, double limit_mm) {
  float& value = values_[CornerIndex(x, y, z)];
  if (!(limit_mm < static_cast<double>(value))) return;
  value = static_cast<float>(limit_mm);
  has_changed_ = true;
}

void SweptTile::CoverNode(int level, const GridCell& node) {
  const int side = 1 << level;
  const GridCell low = node * side;
  for (int z = low.z(); z <= low.z() + side; ++z)
    for (int y = low.y(); y <= low.y() + side; ++y)
      for (int x = low.x(); x <= low.x() + side; ++x) Lower(x, y, z, static_cast<double>(below_));
}

CornerLimits SweptTile::ValuesOf(const GridCell& cell) const {
  CornerLimits values;
  for (int c = 0; c < static_cast<int>(kCellCorners); ++c)
    values[static_cast<std::size_t>(c)] = static_cast<double>(
        values_[CornerIndex(cell.x() + (c & 1), cell.y() + ((c >> 1) & 1), cell.z() + (c >> 2))]);
  return values;
}

void SweptTile::BoundCell(const GridCell& cell, const VisualHull& hull, const UndecidedCameras& open,
                          SweptWork* work) {
  const CornerLimits values = ValuesOf(cell);
  if (std::ranges::all_of(values, [](double value) { return value < 0.0; })) {
    ++work->covered_cells;
    return;
  }
  ++work->bounded_cells;
  const auto limits = LimitsOf(hull, {grid_->At(first_ + cell), grid_->cell_mm}, open, values, options_);
  if (!limits) return;
  for (int c = 0; c < static_cast<int>(kCellCorners); ++c)
    Lower(cell.x() + (c & 1), cell.y() + ((c >> 1) & 1), cell.z() + (c >> 2),
          (*limits)[static_cast<std::size_t>(c)]);
}

void SweptTile::FindCovered() {
  has_changed_ = false;
  std::array<std::uint32_t, kTileCorners * kTileCorners> inside{};
  for (std::size_t row = 0; row < inside.size(); ++row)
    for (std::size_t x = 0; x < kTileCorners; ++x)
      inside[row] |= values_[row * kTileCorners + x] < 0.0F ? 1U << x : 0U;
  for (std::size_t z = 0; z < kTileCells; ++z) {
    for (std::size_t y = 0; y < kTileCells; ++y) {
      const std::size_t row = y + kTileCorners * z;
      const std::uint32_t all =
          inside[row] & inside[row + 1] & inside[row + kTileCorners] & inside[row + kTileCorners + 1];
      covered_[y + kTileCells * z] = static_cast<std::uint16_t>(all & (all >> 1U));
    }
  }
}

void SweptTile::SetBuried(const CellRows& buried) {
  if (std::ranges::all_of(buried, [](std::uint16_t row) { return row == 0xFFFF; })) {
    std::vector<float>().swap(values_);
    std::vector<double>().swap(seconds_);
    std::vector<bool>().swap(buried_);
    return;
  }
  for (int z = 0; z < kTileCells; ++z)
    for (int y = 0; y < kTileCells; ++y)
      for (int x = 0; x < kTileCells; ++x)
        buried_[NodeIndex(0, x, y, z)] =
            (buried[static_cast<std::size_t>(y + kTileCells * z)] >> x & 1U) != 0;
  for (int level = 1; level < kLevels; ++level) {
    const int side = kTileCells >> level;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          bool all = true;
          for (int child = 0; child < 8 && all; ++child)
            all = buried_[NodeIndex(level - 1, 2 * x + (child & 1), 2 * y + ((child >> 1) & 1),
                                    2 * z + (child >> 2))];
          buried_[NodeIndex(level, x, y, z)] = all;
        }
  }
}

}  // namespace elbowroom::recon
