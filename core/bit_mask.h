// A silhouette as one bit a pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace elbowroom::core {

// width x height bits, rows padded to whole 64-bit words (padding is always zero). Pixel (x, y) covers the
// square [x - 0.5, x + 0.5) x [y - 0.5, y + 0.5): pixel centres at integers.
class BitMask {
 public:
  BitMask() = default;
  BitMask(int width_px, int height_px);  // all background

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] std::size_t words_per_row() const { return words_per_row_; }

  [[nodiscard]] bool At(int x, int y) const {
    return (words_[Index(x, y)] >> (static_cast<unsigned>(x) & 63U)) & 1U;
  }
  void Set(int x, int y, bool object) {
    const std::uint64_t bit = std::uint64_t{1} << (static_cast<unsigned>(x) & 63U);
    std::uint64_t& word = words_[Index(x, y)];
    word = object ? (word | bit) : (word & ~bit);
  }

  void SetAll();  // every pixel is object

  // Row-major words, least significant bit = smallest x; writers must keep the padding zero.
  [[nodiscard]] std::span<const std::uint64_t> words() const { return words_; }
  [[nodiscard]] std::span<std::uint64_t> words() { return words_; }

  [[nodiscard]] std::size_t CountObjectPixels() const;
  [[nodiscard]] bool ShowsObject() const;  // true if a pixel is object
  [[nodiscard]] bool operator==(const BitMask&) const = default;

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * words_per_row_ + (static_cast<std::size_t>(x) >> 6U);
  }

  int width_px_ = 0;
  int height_px_ = 0;
  std::size_t words_per_row_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace elbowroom::core
