#include "recon/cell_distances.h"

#include <algorithm>
#include <cmath>

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

// nearest[x] = min(nearest[x], squares[x - step] + across, squares[x + step] + across), of those that there
// are.
void TakeNearerBlocks(const float* __restrict squares, float across, std::size_t step, std::size_t width,
                      float* __restrict nearest) {
  for (std::size_t x = step; x < width; ++x) nearest[x] = std::min(nearest[x], squares[x - step] + across);
  for (std::size_t x = 0; x + step < width; ++x)
    nearest[x] = std::min(nearest[x], squares[x + step] + across);
}

}  // namespace

CellDistances::CellDistances(int width, int height, std::span<const std::uint32_t> first)
    : width_(static_cast<std::size_t>(width)), height_(static_cast<std::size_t>(height)) {
  FillNear(DistancesDown(width_, height_, first));
  FillBlocks(first);
}

void CellDistances::FillNear(std::span<const std::uint8_t> down) {
  constexpr auto kFar = static_cast<std::uint8_t>(kNear * kNear);
  near_squares_.assign(width_ * height_ + LabelRaster::kBytesBehind, kFar);
  // Two of them together fit a byte.
  static_assert(2 * kNear * kNear <= 255);
  // A row of squares with kNear far ones on both sides, so that the loops below run without a test.
  std::vector<std::uint8_t> squares(width_ + 2 * kNear, kFar);
  for (std::size_t y = 0; y < height_; ++y) {
    for (std::size_t x = 0; x < width_; ++x) {
      const std::uint8_t cells = down[y * width_ + x];
      squares[x + kNear] = static_cast<std::uint8_t>(cells * cells);
    }
    for (int dx = -kNear; dx <= kNear; ++dx) {
      TakeNearer(squares.data() + kNear + dx, static_cast<std::uint8_t>(dx * dx), width_,
                 near_squares_.data() + y * width_);
    }
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
  std::vector<float> squares(block_width_);
  for (std::size_t y = 0; y < block_height_; ++y) {
    for (std::size_t x = 0; x < block_width_; ++x) {
      const auto along = static_cast<float>(gap(down[y * block_width_ + x]));
      squares[x] = along * along;
    }
    float* const nearest = blocks_.data() + y * block_width_;
    std::copy(squares.begin(), squares.end(), nearest);
    // All of the row outwards, as long as a column can be nearer; that is asked now and then.
    constexpr std::size_t kStepsUnasked = 8;
    for (std::size_t step = 1; step < block_width_; ++step) {
      const auto across = static_cast<float>(gap(static_cast<int>(step)));
      if (step % kStepsUnasked == 1 && across * across >= *std::max_element(nearest, nearest + block_width_))
        break;
      TakeNearerBlocks(squares.data(), across * across, step, block_width_, nearest);
    }
    for (std::size_t x = 0; x < block_width_; ++x)
      nearest[x] = std::max(std::sqrt(nearest[x]) * (1.0F - 1e-6F), static_cast<float>(kNear));
  }
}

}  // namespace elbowroom::recon
