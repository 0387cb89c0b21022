#include "recon/cell_distances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "recon/label_raster.h"

namespace elbowroom::recon {
namespace {

constexpr int kNear = CellDistances::kNearCells;

// Cells up or down to the nearest one that holds something, at most kNear. Two sweeps of whole rows.
std::vector<std::uint8_t> DistancesDown(std::size_t width, std::size_t height,
                                        std::span<const std::uint32_t> first) {
  std::vector<std::uint8_t> down(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      const int above = y > 0 ? down[i - width] : kNear;
      down[i] = static_cast<std::uint8_t>(first[i] != first[i + 1] ? 0 : std::min(above + 1, kNear));
    }
  }
  for (std::size_t i = width * (height - 1); i-- > 0;)
    down[i] = std::min(down[i], static_cast<std::uint8_t>(down[i + width] + 1));
  return down;
}

// nearest[x] = min(nearest[x], squares[x] + across). Bytes may alias anything, so the compiler is told that
// these don't: sixteen or more at a time.
void TakeNearer(const std::uint8_t* __restrict squares, std::uint8_t across, std::size_t width,
                std::uint8_t* __restrict nearest) {
  for (std::size_t x = 0; x < width; ++x) {
    const auto square = static_cast<std::uint8_t>(squares[x] + across);
    nearest[x] = square < nearest[x] ? square : nearest[x];
  }
}

// floor(8 * sqrt(square)), by square.
const std::array<std::uint8_t, kNear * kNear + 1>& Eighths() {
  static const auto table = [] {
    std::array<std::uint8_t, kNear * kNear + 1> result{};
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = static_cast<std::uint8_t>(8.0 * std::sqrt(static_cast<double>(i)));
    return result;
  }();
  return table;
}

}  // namespace

CellDistances::CellDistances(int width, int height, std::span<const std::uint32_t> first)
    : width_(static_cast<std::size_t>(width)), height_(static_cast<std::size_t>(height)) {
  FillNear(DistancesDown(width_, height_, first));
  FillBlocks(first);
}

void CellDistances::FillNear(std::span<const std::uint8_t> down) {
  near_eighths_.resize(width_ * height_ + LabelRaster::kBytesBehind);
  // Two of them together fit a byte.
  constexpr auto kFar = static_cast<std::uint8_t>(kNear * kNear);
  static_assert(2 * kNear * kNear <= 255);
  // A row of squares with kNear far ones on both sides, so that the loops below run without a test.
  std::vector<std::uint8_t> squares(width_ + 2 * kNear, kFar), nearest(width_);
  for (std::size_t y = 0; y < height_; ++y) {
    for (std::size_t x = 0; x < width_; ++x) {
      const std::uint8_t cells = down[y * width_ + x];
      squares[x + kNear] = static_cast<std::uint8_t>(cells * cells);
    }
    std::fill(nearest.begin(), nearest.end(), kFar);
    for (int dx = -kNear; dx <= kNear; ++dx) {
      TakeNearer(squares.data() + kNear + dx, static_cast<std::uint8_t>(dx * dx), width_, nearest.data());
    }
    for (std::size_t x = 0; x < width_; ++x) near_eighths_[y * width_ + x] = Eighths()[nearest[x]];
  }
}

void CellDistances::FillBlocks(std::span<const std::uint32_t> first) {
  block_width_ = (width_ + kBlock - 1) / kBlock, block_height_ = (height_ + kBlock - 1) / kBlock;
  std::vector<std::uint8_t> holds(block_width_ * block_height_, 0);
  for (std::size_t y = 0; y < height_; ++y) {
    for (std::size_t x = 0; x < width_; x += kBlock) {
      const std::size_t end = y * width_ + std::min(x + kBlock, width_);
      if (first[y * width_ + x] != first[end]) holds[y / kBlock * block_width_ + x / kBlock] = 1;
    }
  }
  // Down the columns of blocks, then along the rows: few blocks, no cap.
  const auto far = static_cast<int>(block_width_ + block_height_);
  std::vector<int> down(holds.size());
  for (std::size_t i = 0; i < holds.size(); ++i)
    down[i] = holds[i] ? 0 : i >= block_width_ ? std::min(down[i - block_width_] + 1, far) : far;
  for (std::size_t i = holds.size() - block_width_; i-- > 0;)
    down[i] = std::min(down[i], down[i + block_width_] + 1);
  blocks_.resize(holds.size());
  const auto gap = [](int blocks) { return std::max(blocks - 1, 0) * kBlock + (blocks > 0 ? 1 : 0); };
  for (std::size_t y = 0; y < block_height_; ++y) {
    for (std::size_t x = 0; x < block_width_; ++x) {
      // Outwards from the block itself, as long as a column can be nearer.
      double square = std::numeric_limits<double>::max();
      for (std::size_t step = 0; step < block_width_; ++step) {
        const double across = gap(static_cast<int>(step));
        if (across * across >= square) break;
        for (const std::size_t other : {x - step, x + step}) {
          if (other >= block_width_) continue;  // also of a wrapped x - step
          const double along = gap(down[y * block_width_ + other]);
          square = std::min(square, across * across + along * along);
        }
      }
      blocks_[y * block_width_ + x] =
          std::max(static_cast<float>(std::sqrt(square)) * (1.0F - 1e-6F), static_cast<float>(kNear));
    }
  }
}

}  // namespace elbowroom::recon
