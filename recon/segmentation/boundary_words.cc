#include "recon/segmentation/boundary_words.h"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "core/soft_mask.h"

// Highway compiles what stands between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE once a target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/segmentation/boundary_words.cc"  // NOLINT(bugprone-macro-parentheses)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon {
namespace HWY_NAMESPACE {  // NOLINT(google-build-namespaces)
namespace hn = hwy::HWY_NAMESPACE;

// Bit i: word i of `count` (at most 64) may hold boundary pixels. A word is compared with itself moved by a
// pixel to either side, and with the words above and below. Words are taken as if the mask's rows were one
// long row. So the first and the last pixel of a row are compared with other pixels than their neighbours,
// which they don't have: that can only add words. What is left of less than a vector is added, too.
std::uint64_t MayHoldBoundary(const std::uint64_t* words, std::size_t per_row, std::size_t count) {
  const hn::CappedTag<std::uint64_t, 8> d;
  const std::size_t lanes = hn::Lanes(d);
  std::uint64_t found = 0;
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const std::uint64_t* at = words + i;
    const auto here = hn::LoadU(d, at);
    const auto left = hn::Or(hn::ShiftLeft<1>(here), hn::ShiftRight<63>(hn::LoadU(d, at - 1)));
    const auto right = hn::Or(hn::ShiftRight<1>(here), hn::ShiftLeft<63>(hn::LoadU(d, at + 1)));
    const auto across = hn::Or(hn::Xor(here, left), hn::Xor(here, right));
    const auto down =
        hn::Or(hn::Xor(here, hn::LoadU(d, at - per_row)), hn::Xor(here, hn::LoadU(d, at + per_row)));
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::Ne(hn::Or(across, down), hn::Zero(d)), bytes);
    found |= std::uint64_t{bytes[0]} << i;
  }
  return i < count ? found | (~std::uint64_t{0} << i) : found;
}

}  // namespace HWY_NAMESPACE
}  // namespace elbowroom::recon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {
namespace {

HWY_EXPORT(MayHoldBoundary);

constexpr std::size_t kBlock = 64;

// Adds the words of a list that hold boundary pixels. Words come in order.
class WordList {
 public:
  WordList(const core::BitMask& mask, MaskRows rows)
      : mask_(mask), y_(static_cast<std::size_t>(rows.begin)), row_begin_(y_ * mask.words_per_row()) {}

  void AddIfOnBoundary(std::size_t word) {
    const std::size_t per_row = mask_.words_per_row();
    for (; word >= row_begin_ + per_row; ++y_) row_begin_ += per_row;
    const std::uint64_t bits = core::BoundaryOfWord(mask_, y_, word - row_begin_);
    if (bits != 0) words_.push_back({static_cast<int>((word - row_begin_) * 64), static_cast<int>(y_), bits});
  }
  [[nodiscard]] std::vector<PixelWord> Take() && { return std::move(words_); }

 private:
  const core::BitMask& mask_;
  std::size_t y_, row_begin_;
  std::vector<PixelWord> words_;
};

}  // namespace

std::vector<PixelWord> BoundaryWords(const core::BitMask& mask, MaskRows rows) {
  const std::size_t per_row = mask.words_per_row(), all = mask.words().size();
  const std::size_t begin = static_cast<std::size_t>(rows.begin) * per_row;
  const std::size_t end = static_cast<std::size_t>(rows.end) * per_row;
  WordList list(mask, rows);
  // The picture's first and last row lack a neighbour, so all of their words are tried.
  const std::size_t inner = std::min(std::max(begin, per_row), end);
  const std::size_t inner_end = std::max(std::min(end, all - per_row), inner);
  for (std::size_t word = begin; word < inner; ++word) list.AddIfOnBoundary(word);
  for (std::size_t word = inner; word < inner_end; word += kBlock) {
    const std::size_t count = std::min(kBlock, inner_end - word);
    std::uint64_t left = HWY_DYNAMIC_DISPATCH(MayHoldBoundary)(mask.words().data() + word, per_row, count);
    if (count < kBlock) left &= (std::uint64_t{1} << count) - 1;
    for (; left != 0; left &= left - 1)
      list.AddIfOnBoundary(word + static_cast<std::size_t>(std::countr_zero(left)));
  }
  for (std::size_t word = inner_end; word < end; ++word) list.AddIfOnBoundary(word);
  return std::move(list).Take();
}

}  // namespace elbowroom::recon
#endif  // HWY_ONCE
