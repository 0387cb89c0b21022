#include "recon/swept_volume/swept_burial.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace elbowroom::recon {
namespace {

// A tile's rows of covered cells with one cell more on each side, from the tiles around it: bit x + 1 of row
// y + 1, z + 1.
class WideRows {
 public:
  explicit WideRows(const TilesAround& around) {
    for (int z = -1; z <= kTileCells; ++z) {
      for (int y = -1; y <= kTileCells; ++y) {
        const std::uint32_t before = Row(around, -1, y, z) >> (kTileCells - 1U);
        const std::uint32_t after = Row(around, 1, y, z) & 1U;
        rows_[static_cast<std::size_t>(y + 1) + kWide * static_cast<std::size_t>(z + 1)] =
            before | Row(around, 0, y, z) << 1U | after << (kTileCells + 1U);
      }
    }
  }

  // The cells that have their bits, and all of whose neighbours have theirs.
  [[nodiscard]] CellRows Buried() const {
    CellRows buried{};
    for (std::size_t z = 0; z < kTileCells; ++z) {
      for (std::size_t y = 0; y < kTileCells; ++y) {
        std::uint32_t all = ~0U;
        for (std::size_t k = 0; k < 9; ++k) all &= rows_[y + k % 3 + kWide * (z + k / 3)];
        buried[y + kTileCells * z] = static_cast<std::uint16_t>(all & (all >> 1U) & (all >> 2U));
      }
    }
    return buried;
  }

 private:
  static constexpr std::size_t kWide = kTileCells + 2;

  // The row of the tile that is `x` tiles further along x.
  static std::uint32_t Row(const TilesAround& around, int x, int y, int z) {
    const auto step = [](int cell) { return cell < 0 ? 0 : cell < kTileCells ? 1 : 2; };
    const SweptTile* tile = around[static_cast<std::size_t>(x + 1 + 3 * (step(y) + 3 * step(z)))];
    const auto within = [](int cell) { return (cell + kTileCells) % kTileCells; };
    return tile == nullptr ? 0U
                           : tile->covered()[static_cast<std::size_t>(within(y) + kTileCells * within(z))];
  }

  std::array<std::uint32_t, kWide * kWide> rows_{};
};

}  // namespace

void UpdateBuried(std::span<PlacedTile* const> added, SweptTiles* tiles) {
  std::vector<PlacedTile*> changed;
  std::ranges::copy_if(added, std::back_inserter(changed), [](const PlacedTile* tile) {
    return !tile->cells.is_buried() && tile->cells.has_changed();
  });
  tbb::parallel_for(std::size_t{0}, changed.size(), [&](std::size_t i) { changed[i]->cells.FindCovered(); });
  // The change is news to their neighbours, too.
  std::map<std::uint64_t, PlacedTile*> near;
  for (const PlacedTile* tile : changed) {
    for (int k = 0; k < 27; ++k) {
      const auto found = tiles->find(CurveKey(tile->tile + GridCell(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (found != tiles->end() && !found->second.cells.is_buried()) near[found->first] = &found->second;
    }
  }
  std::vector<PlacedTile*> all;
  for (const auto& [key, tile] : near) all.push_back(tile);
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    all[i]->cells.SetBuried(WideRows(FindAround(*tiles, all[i]->tile)).Buried());
  });
}

}  // namespace elbowroom::recon
