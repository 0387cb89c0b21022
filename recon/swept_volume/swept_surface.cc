#include "recon/swept_volume/swept_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include "core/error.h"
#include "recon/swept_volume/kuhn_cell.h"

namespace elbowroom::recon {
namespace {

constexpr const char* kWhat = "meshing the swept volume";

GridCell StepOf(int k) { return {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1}; }
GridCell BitsOf(unsigned corner) {
  return {static_cast<int>(corner & 1U), static_cast<int>(corner >> 1U & 1U), static_cast<int>(corner >> 2U)};
}

// The values at a tile's corners, lowered by the cells of the tiles around it too, and the time in its cells
// and those next to it.
class TileValues {
 public:
  TileValues(const SweptTiles& tiles, const GridCell& tile, const SweptGrid& grid)
      : around_(FindAround(tiles, tile)), values_(kCount, SweptTile::Unset(grid)) {
    for (int k = 0; k < 27; ++k)
      if (around_[static_cast<std::size_t>(k)] != nullptr)
        TakeFrom(*around_[static_cast<std::size_t>(k)], StepOf(k));
  }

  [[nodiscard]] double At(const GridCell& corner) const {
    return static_cast<double>(values_[Index(corner.x(), corner.y(), corner.z())]);
  }
  [[nodiscard]] bool IsInside(const GridCell& corner) const { return At(corner) < 0.0; }
  [[nodiscard]] bool HasInside() const {
    return std::ranges::any_of(values_, [](float value) { return value < 0.0F; });
  }

  // The longest time of the cells around a corner.
  [[nodiscard]] double SecondsAt(const GridCell& corner) const {
    double longest = 0.0;
    for (unsigned c = 0; c < kCellCorners; ++c) longest = std::max(longest, CellSeconds(corner - BitsOf(c)));
    return longest;
  }

 private:
  static constexpr std::size_t kCount = kTileCorners * kTileCorners * kTileCorners;
  static std::size_t Index(int x, int y, int z) {
    return static_cast<std::size_t>(x + kTileCorners * (y + kTileCorners * z));
  }

  // The corners that the tile shares with one that is `step` tiles away: along an axis all of them, the
  // first ones or the last ones.
  void TakeFrom(const SweptTile& tile, const GridCell& step) {
    const auto first = [](int s) { return s > 0 ? kTileCells : 0; };
    const auto last = [](int s) { return s < 0 ? 0 : kTileCells; };
    for (int z = first(step.z()); z <= last(step.z()); ++z)
      for (int y = first(step.y()); y <= last(step.y()); ++y)
        for (int x = first(step.x()); x <= last(step.x()); ++x) {
          float& value = values_[Index(x, y, z)];
          value = std::min(value, tile.Value(x - step.x() * kTileCells, y - step.y() * kTileCells,
                                             z - step.z() * kTileCells));
        }
  }

  [[nodiscard]] double CellSeconds(const GridCell& cell) const {
    std::size_t tile = 0, factor = 1;
    GridCell within;
    for (int axis = 0; axis < 3; ++axis, factor *= 3) {
      tile += factor * (cell[axis] < 0 ? 0 : cell[axis] < kTileCells ? 1 : 2);
      within[axis] = (cell[axis] + kTileCells) % kTileCells;
    }
    return around_[tile] == nullptr ? 0.0 : around_[tile]->Seconds(within.x(), within.y(), within.z());
  }

  TilesAround around_;
  std::vector<float> values_;
};

// The surface's vertices on the edges that begin at corners of a tile other than its last ones.
struct TileVertices {
  std::vector<std::uint32_t> keys;  // ascending: VertexKey
  std::vector<Eigen::Vector3d> positions_mm;
  std::vector<double> dwell_s;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

std::uint32_t VertexKey(const GridCell& low, unsigned direction) {
  return static_cast<std::uint32_t>(low.x() + kTileCells * (low.y() + kTileCells * low.z())) * 8U + direction;
}

template <typename Visit>
void ForEachCell(const Visit& visit) {
  for (int z = 0; z < kTileCells; ++z)
    for (int y = 0; y < kTileCells; ++y)
      for (int x = 0; x < kTileCells; ++x) visit(GridCell(x, y, z));
}

TileVertices FindVertices(const TileValues& values, const SweptGrid& grid, const GridCell& first) {
  TileVertices found;
  ForEachCell([&](const GridCell& low) {
    const double a = values.At(low);
    for (unsigned direction = 1; direction < kCellCorners; ++direction) {
      const GridCell high = low + BitsOf(direction);
      const double b = values.At(high);
      if ((a < 0.0) == (b < 0.0)) continue;
      const double share = a / (a - b);
      found.keys.push_back(VertexKey(low, direction));
      found.positions_mm.push_back(grid.At(first + low) +
                                   share * grid.cell_mm.cwiseProduct(BitsOf(direction).cast<double>()));
      found.dwell_s.push_back((1.0 - share) * values.SecondsAt(low) + share * values.SecondsAt(high));
    }
  });
  return found;
}

// The tiles whose cells may have a corner inside: those that hulls reached, and those next to them.
std::vector<GridCell> TilesToMesh(const SweptTiles& tiles) {
  std::map<std::uint64_t, GridCell> all;
  for (const auto& [key, placed] : tiles) {
    if (placed.cells.is_buried()) continue;
    for (int k = 0; k < 27; ++k) {
      const GridCell tile = placed.tile + StepOf(k);
      all.emplace(CurveKey(tile), tile);
    }
  }
  std::vector<GridCell> sorted;
  for (const auto& [key, tile] : all) sorted.push_back(tile);
  return sorted;
}

class Surface {
 public:
  Surface(const SweptTiles& tiles, const SweptGrid& grid)
      : tiles_(tiles), grid_(grid), places_(TilesToMesh(tiles)), parts_(places_.size()) {
    keys_.resize(places_.size());
    std::ranges::transform(places_, keys_.begin(), CurveKey);
  }

  SweptMesh Extract(const core::Progress& progress, const std::stop_token& stop) {
    progress.Report(0, 2, "surface");
    tbb::parallel_for(std::size_t{0}, places_.size(), [&](std::size_t i) {
      const TileValues values(tiles_, places_[i], grid_);
      if (!stop.stop_requested() && values.HasInside())
        parts_[i] = FindVertices(values, grid_, places_[i] * kTileCells);
    });
    core::ThrowIfStopped(stop, kWhat);
    NumberVertices();
    progress.Report(1, 2, "surface");
    tbb::parallel_for(std::size_t{0}, places_.size(), [&](std::size_t i) {
      if (!stop.stop_requested()) AddTriangles(i);
    });
    core::ThrowIfStopped(stop, kWhat);
    progress.Report(2, 2, "surface");
    return Join();
  }

 private:
  void NumberVertices() {
    firsts_.assign(1, 0);
    for (const TileVertices& part : parts_) firsts_.push_back(firsts_.back() + part.keys.size());
    if (firsts_.back() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) / 4)
      throw core::Error(
          core::ErrorKind::kRange,
          "swept volume: the mesh has more vertices than files can hold; choose a longer --edge");
  }

  // The number of a vertex in the whole mesh. `corner` counts from the tile's first, and may be in the next.
  [[nodiscard]] std::int32_t NumberOf(std::size_t place, GridCell corner, unsigned direction) const {
    GridCell tile = places_[place];
    for (int axis = 0; axis < 3; ++axis) {
      if (corner[axis] < kTileCells) continue;
      ++tile[axis];
      corner[axis] -= kTileCells;
    }
    if (tile != places_[place])
      place = static_cast<std::size_t>(std::ranges::lower_bound(keys_, CurveKey(tile)) - keys_.begin());
    const auto& keys = parts_[place].keys;
    const auto found = std::ranges::lower_bound(keys, VertexKey(corner, direction));
    return static_cast<std::int32_t>(firsts_[place] + static_cast<std::size_t>(found - keys.begin()));
  }

  void AddTriangles(std::size_t place) {
    const TileValues values(tiles_, places_[place], grid_);
    if (!values.HasInside()) return;
    ForEachCell([&](const GridCell& cell) {
      unsigned inside = 0;
      for (unsigned c = 0; c < kCellCorners; ++c)
        if (values.IsInside(cell + BitsOf(c))) inside |= 1U << c;
      for (const CellTriangle& triangle : CellTriangles(inside)) {
        auto& numbers = parts_[place].triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
          numbers[k] = NumberOf(place, cell + BitsOf(triangle[k].low), triangle[k].high ^ triangle[k].low);
      }
    });
  }

  [[nodiscard]] SweptMesh Join() const {
    SweptMesh result;
    for (const TileVertices& part : parts_) {
      auto& mesh = result.mesh;
      mesh.vertices_mm.insert(mesh.vertices_mm.end(), part.positions_mm.begin(), part.positions_mm.end());
      mesh.triangles.insert(mesh.triangles.end(), part.triangles.begin(), part.triangles.end());
      result.dwell_s.insert(result.dwell_s.end(), part.dwell_s.begin(), part.dwell_s.end());
    }
    return result;
  }

  const SweptTiles& tiles_;
  const SweptGrid& grid_;
  std::vector<GridCell> places_;  // along the curve
  std::vector<std::uint64_t> keys_;
  std::vector<TileVertices> parts_;
  std::vector<std::size_t> firsts_;
};

}  // namespace

TilesAround FindAround(const SweptTiles& tiles, const GridCell& tile) {
  TilesAround around{};
  for (int k = 0; k < 27; ++k) {
    const auto found = tiles.find(CurveKey(tile + StepOf(k)));
    if (found != tiles.end()) around[static_cast<std::size_t>(k)] = &found->second.cells;
  }
  return around;
}

SweptMesh ExtractSurface(const SweptTiles& tiles, const SweptGrid& grid, const core::Progress& progress,
                         const std::stop_token& stop) {
  return Surface(tiles, grid).Extract(progress, stop);
}

}  // namespace elbowroom::recon
