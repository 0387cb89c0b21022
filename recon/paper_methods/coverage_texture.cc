#include "recon/paper_methods/coverage_texture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace elbowroom::recon {
namespace {

constexpr std::uint8_t kObject = 255;
constexpr std::size_t kReadBeyond = 4;

// Eight bits as eight bytes of 0 or 255.
constexpr std::array<std::uint64_t, 256> kBytesOfBits = [] {
  std::array<std::uint64_t, 256> bytes{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    for (unsigned i = 0; i < 8; ++i) {
      if ((bits >> i) & 1U) bytes[bits] |= std::uint64_t{kObject} << (8 * i);
    }
  }
  return bytes;
}();

// Object pixels' smallest rectangle, both ends included; empty box if there are none.
Eigen::AlignedBox2i ObjectRectangle(const core::BitMask& mask) {
  Eigen::AlignedBox2i box;
  const std::size_t words = mask.words_per_row();
  std::vector<std::uint64_t> columns(words, 0);
  for (int y = 0; y < mask.height_px(); ++y) {
    const std::uint64_t* row = mask.words().data() + static_cast<std::size_t>(y) * words;
    std::uint64_t any = 0;
    for (std::size_t i = 0; i < words; ++i) {
      columns[i] |= row[i];
      any |= row[i];
    }
    if (any == 0) continue;
    box.extend(Eigen::Vector2i(0, y));
  }
  if (box.isEmpty()) return box;
  const auto is_used = [](std::uint64_t word) { return word != 0; };
  const auto first = std::find_if(columns.begin(), columns.end(), is_used);
  const auto last = std::find_if(columns.rbegin(), columns.rend(), is_used);
  box.min().x() = static_cast<int>(first - columns.begin()) * 64 + std::countr_zero(*first);
  box.max().x() = static_cast<int>(columns.rend() - last) * 64 - 1 - std::countl_zero(*last);
  return box;
}

// Texels of one row of the picture, from `left_px` on; columns beyond the picture repeat its border's.
void FillRow(const core::BitMask& mask, int y, CoverageTexture* texture, std::uint8_t* row) {
  const std::uint64_t* words = mask.words().data() + static_cast<std::size_t>(y) * mask.words_per_row();
  const int begin = std::max(texture->left_px, 0),
            end = std::min(texture->left_px + texture->width_texels, mask.width_px());
  int x = begin;
  for (; x < end && (x & 7) != 0; ++x) row[x - texture->left_px] = mask.At(x, y) ? kObject : 0;
  for (; x + 8 <= end; x += 8) {
    const std::uint64_t word = words[static_cast<std::size_t>(x) >> 6U];
    const std::uint64_t bytes = kBytesOfBits[(word >> (static_cast<unsigned>(x) & 63U)) & 0xFFU];
    std::memcpy(row + (x - texture->left_px), &bytes, sizeof bytes);
  }
  for (; x < end; ++x) row[x - texture->left_px] = mask.At(x, y) ? kObject : 0;
}

void WriteLevels(const core::SoftMask& soft, CoverageTexture* texture) {
  const core::BitMask boundary = core::BoundaryPixels(soft.mask);
  const std::size_t words = boundary.words_per_row();
  std::size_t next = 0;
  for (std::size_t i = 0; i < boundary.words().size(); ++i) {
    const int y = static_cast<int>(i / words);
    for (std::uint64_t bits = boundary.words()[i]; bits != 0; bits &= bits - 1) {
      const int x = static_cast<int>(i % words * 64) + std::countr_zero(bits);
      const auto column = static_cast<std::size_t>(x - texture->left_px);
      const auto row = static_cast<std::size_t>(y - texture->top_px);
      texture->texels[row * static_cast<std::size_t>(texture->width_texels) + column] = soft.levels[next++];
    }
  }
}

void RepeatBorder(const core::BitMask& mask, CoverageTexture* texture) {
  const auto width = static_cast<std::size_t>(texture->width_texels),
             height = static_cast<std::size_t>(texture->height_texels);
  std::uint8_t* texels = texture->texels.data();
  const bool left = texture->left_px<0, right = texture->left_px + texture->width_texels> mask.width_px();
  for (std::size_t y = 0; y < height; ++y) {
    if (left) texels[y * width] = texels[y * width + 1];
    if (right) texels[y * width + width - 1] = texels[y * width + width - 2];
  }
  if (texture->top_px < 0) std::copy_n(texels + width, width, texels);
  if (texture->top_px + texture->height_texels > mask.height_px()) {
    std::copy_n(texels + (height - 2) * width, width, texels + (height - 1) * width);
  }
}

}  // namespace

CoverageTexture MakeCoverageTexture(const core::SoftMask& soft) {
  CoverageTexture texture;
  const core::BitMask& mask = soft.mask;
  const Eigen::AlignedBox2i object = ObjectRectangle(mask);
  if (object.isEmpty()) {
    texture.valid_px = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero());
    texture.texels.resize(kReadBeyond);
    return texture;
  }
  texture.left_px = object.min().x() - 1;
  texture.top_px = object.min().y() - 1;
  texture.width_texels = object.sizes().x() + 3;
  texture.height_texels = object.sizes().y() + 3;
  texture.valid_px.min() =
      Eigen::Vector2d(std::max(texture.left_px + 0.0, -0.5), std::max(texture.top_px + 0.0, -0.5));
  texture.valid_px.max() = Eigen::Vector2d(std::min(object.max().x() + 1.0, mask.width_px() - 0.5),
                                           std::min(object.max().y() + 1.0, mask.height_px() - 0.5));
  const auto width = static_cast<std::size_t>(texture.width_texels);
  texture.texels.resize(width * static_cast<std::size_t>(texture.height_texels) + kReadBeyond);
  const int end = std::min(texture.top_px + texture.height_texels, mask.height_px());
  for (int y = std::max(texture.top_px, 0); y < end; ++y) {
    FillRow(mask, y, &texture, texture.texels.data() + static_cast<std::size_t>(y - texture.top_px) * width);
  }
  if (!soft.levels.empty()) WriteLevels(soft, &texture);
  RepeatBorder(mask, &texture);
  return texture;
}

double CoverageAt(const CoverageTexture& texture, const Eigen::Vector2d& position_px) {
  const Eigen::AlignedBox2d& valid = texture.valid_px;
  if ((position_px.array() < valid.min().array()).any() || (position_px.array() >= valid.max().array()).any())
    return 0.0;
  const double x = position_px.x() - texture.left_px, y = position_px.y() - texture.top_px;
  const double column = std::floor(x), row = std::floor(y), u = x - column, v = y - row;
  const auto width = static_cast<std::size_t>(texture.width_texels);
  const std::uint8_t* texel =
      texture.texels.data() + static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
  return (1.0 - v) * ((1.0 - u) * texel[0] + u * texel[1]) +
         v * ((1.0 - u) * texel[width] + u * texel[width + 1]);
}

BlockOccupancy::BlockOccupancy(const core::BitMask& mask) {
  const int blocks_x = (mask.width_px() + 7) / 8, blocks_y = (mask.height_px() + 7) / 8;
  stride_ = blocks_x + 1;
  const auto stride = static_cast<std::size_t>(stride_);
  object_.assign(stride * static_cast<std::size_t>(blocks_y + 1), 0);
  background_ = object_;
  const std::size_t words = mask.words_per_row();
  const unsigned used = static_cast<unsigned>(mask.width_px()) & 63U;
  const std::uint64_t padding = used == 0 ? 0 : ~std::uint64_t{0} << used;
  for (int block_y = 0; block_y < blocks_y; ++block_y) {
    const std::size_t above = static_cast<std::size_t>(block_y) * stride, here = above + stride;
    int objects = 0, backgrounds = 0;  // in this row of blocks so far
    for (std::size_t word = 0; word < words; ++word) {
      std::uint64_t any = 0, all = ~std::uint64_t{0};
      for (int y = block_y * 8; y < std::min(block_y * 8 + 8, mask.height_px()); ++y) {
        const std::uint64_t bits = mask.words()[static_cast<std::size_t>(y) * words + word];
        any |= bits;
        all &= bits;
      }
      if (word + 1 == words) all |= padding;
      for (std::size_t x = word * 8; x < std::min(word * 8 + 8, stride - 1); ++x, any >>= 8U, all >>= 8U) {
        objects += (any & 0xFFU) != 0 ? 1 : 0;
        backgrounds += (all & 0xFFU) != 0xFFU ? 1 : 0;
        object_[here + x + 1] = object_[above + x + 1] + objects;
        background_[here + x + 1] = background_[above + x + 1] + backgrounds;
      }
    }
  }
}

}  // namespace elbowroom::recon
