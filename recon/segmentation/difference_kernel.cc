#include "recon/segmentation/difference_kernel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "core/error.h"

// Highway compiles what stands between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE once a target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/segmentation/difference_kernel.cc"  // NOLINT(bugprone-macro-parentheses)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef ELBOWROOM_RECON_DIFFERENCE_KERNEL_ROWS
#define ELBOWROOM_RECON_DIFFERENCE_KERNEL_ROWS
namespace elbowroom::recon {
namespace {

// Rows of a table, from the first on.
template <typename T>
struct Rows {
  T* first = nullptr;
  std::size_t stride = 0;  // in elements

  [[nodiscard]] T* at(std::size_t row) const { return first + row * stride; }
};

// A picture, its ranges, and the mask to write. A group is LevelRanges::kSharingRows rows below one another.
struct Comparison {
  std::size_t width = 0, height = 0;
  Rows<const std::uint8_t> image;
  Rows<const std::uint8_t> ranges;         // a row for each group; a cell's rows follow one another
  Rows<const std::uint8_t> shared_lowest;  // a row for each group
  Rows<const std::int16_t> shared_width;   // likewise
  Rows<const float> mean;                  // likewise
  const ShadeRule* shade = nullptr;
  Rows<std::uint64_t> out;

  [[nodiscard]] std::size_t RowsOfGroup(std::size_t group) const {
    return std::min<std::size_t>(LevelRanges::kSharingRows, height - group * LevelRanges::kSharingRows);
  }
};

}  // namespace
}  // namespace elbowroom::recon
#endif

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon {
namespace HWY_NAMESPACE {  // NOLINT(google-build-namespaces)
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kWordBytes = 192;              // of 64 pixels
constexpr std::size_t kRangeBytes = 2 * kWordBytes;  // their lowest and highest levels
constexpr std::size_t kCellBytes = LevelRanges::kSharingRows * kRangeBytes;
// The bytes that are looked at in all rows of a cell but the first. They hold pixels 22 to 41 wholly, and fit
// one vector of 64 bytes.
constexpr std::size_t kLookFrom = 64, kLookTo = 128;

// ORs the three bits of each of 16 pixels and closes the gaps.
HWY_INLINE std::uint64_t PixelsOf16(std::uint64_t channels) {
  std::uint64_t x = (channels | (channels >> 1U) | (channels >> 2U)) & 0x0000249249249249U;
  x = (x ^ (x >> 2U)) & 0x10c30c30c30c30c3U;
  x = (x ^ (x >> 4U)) & 0x100f00f00f00f00fU;
  x = (x ^ (x >> 8U)) & 0x001f0000ff0000ffU;
  x = (x ^ (x >> 16U)) & 0x001f00000000ffffU;
  return x & 0xffffU;
}

HWY_INLINE std::uint64_t PixelsOf64(const std::uint64_t (&c)[3]) {
  return PixelsOf16(c[0]) | (PixelsOf16((c[0] >> 48U) | (c[1] << 16U)) << 16U) |
         (PixelsOf16((c[1] >> 32U) | (c[2] << 32U)) << 32U) | (PixelsOf16(c[2] >> 16U) << 48U);
}

using Bytes = hn::CappedTag<std::uint8_t, 64>;

// Not zero where a level is outside of its range: lowest - level or level - highest, whichever is above zero.
HWY_INLINE hn::Vec<Bytes> Outside(const std::uint8_t* image, const std::uint8_t* ranges) {
  const Bytes d;
  const auto level = hn::LoadU(d, image);
  return hn::Or(hn::SaturatedSub(hn::Load(d, ranges), level),
                hn::SaturatedSub(level, hn::Load(d, ranges + kWordBytes)));
}

// How far levels [begin, end) of 64 pixels are above the lowest: the farthest of each lane. A level below it
// wraps around, to more than any width.
HWY_INLINE hn::Vec<Bytes> FarthestAbove(const std::uint8_t* image, const std::uint8_t* lowest,
                                        std::size_t begin, std::size_t end) {
  const Bytes d;
  auto farthest = hn::Sub(hn::LoadU(d, image + begin), hn::Load(d, lowest + begin));
  for (std::size_t i = begin + hn::Lanes(d); i < end; i += hn::Lanes(d))
    farthest = hn::Max(farthest, hn::Sub(hn::LoadU(d, image + i), hn::Load(d, lowest + i)));
  return farthest;
}
HWY_INLINE bool AreWithin(hn::Vec<Bytes> above, std::int16_t width) {
  const Bytes d;
  const auto too_far = hn::SaturatedSub(above, hn::Set(d, static_cast<std::uint8_t>(width)));
  return width >= 0 && hn::AllTrue(d, hn::Eq(too_far, hn::Zero(d)));
}

// Whether one of levels [begin, end) of 64 pixels is outside of its range.
HWY_INLINE bool IsOutside(const std::uint8_t* image, const std::uint8_t* ranges, std::size_t begin,
                          std::size_t end) {
  const Bytes d;
  auto outside = Outside(image + begin, ranges + begin);
  for (std::size_t i = begin + hn::Lanes(d); i < end; i += hn::Lanes(d))
    outside = hn::Or(outside, Outside(image + i, ranges + i));
  return !hn::AllTrue(d, hn::Eq(outside, hn::Zero(d)));
}

// Bit i: pixel i of 64 has a channel outside of its range. Channels stay interleaved: only bits are merged.
HWY_INLINE std::uint64_t Differing(const std::uint8_t* image, const std::uint8_t* ranges) {
  const Bytes d;
  const std::size_t lanes = hn::Lanes(d);
  const auto zero = hn::Zero(d);
  std::uint64_t channels[3] = {};
  if constexpr (hn::MaxLanes(d) < 8) {  // plain code: one lane
    for (std::size_t i = 0; i < kWordBytes; i += lanes)
      channels[i / 64] |= std::uint64_t{hn::GetLane(Outside(image + i, ranges + i)) != 0} << (i % 64);
  } else {
    std::uint8_t bytes[kWordBytes / 8 + 8];
    for (std::size_t i = 0; i < kWordBytes; i += lanes)
      hn::StoreMaskBits(d, hn::Ne(Outside(image + i, ranges + i), zero), bytes + i / 8);
    std::memcpy(channels, bytes, sizeof channels);
  }
  return (channels[0] | channels[1] | channels[2]) == 0 ? 0 : PixelsOf64(channels);
}

template <class DF>
HWY_INLINE hn::Vec<DF> FloatsOf(DF df, hn::Vec<hn::Rebind<std::uint8_t, DF>> levels) {
  return hn::ConvertTo(df, hn::PromoteTo(hn::Rebind<std::int32_t, DF>(), levels));
}

// Bit i: pixel i of 64 is shade; pixels that aren't candidates needn't be decided. No contraction to fused
// multiply-add, so that every target rounds alike.
HWY_INLINE std::uint64_t Shade(std::uint64_t candidates, const std::uint8_t* image, const float* mean,
                               const ShadeRule& rule) {
  const hn::CappedTag<float, 64> df;
  const hn::Rebind<std::uint8_t, decltype(df)> du;
  using V = hn::Vec<decltype(df)>;
  const V darkest = hn::Set(df, rule.darkest), chroma2 = hn::Set(df, rule.chroma * rule.chroma);
  const V noise2 = hn::Set(df, rule.noise_levels * rule.noise_levels);
  std::uint64_t bits = 0;
  const std::uint64_t group =
      hn::Lanes(df) < 64 ? (std::uint64_t{1} << hn::Lanes(df)) - 1 : ~std::uint64_t{0};
  for (std::size_t i = 0; i < 64; i += hn::Lanes(df)) {
    if (((candidates >> i) & group) == 0) continue;
    hn::Vec<decltype(du)> image_b, image_g, image_r;
    hn::LoadInterleaved3(du, image + 3 * i, image_b, image_g, image_r);
    const V ib = FloatsOf(df, image_b), ig = FloatsOf(df, image_g), ir = FloatsOf(df, image_r);
    V mb, mg, mr;
    hn::LoadInterleaved3(df, mean + 3 * i, mb, mg, mr);
    const auto dot = [](V a, V b, V c, V x, V y, V z)
                         HWY_ATTR { return hn::Add(hn::Add(hn::Mul(a, x), hn::Mul(b, y)), hn::Mul(c, z)); };
    const V im = dot(ib, ig, ir, mb, mg, mr), mm = dot(mb, mg, mr, mb, mg, mr);
    const V ii = dot(ib, ig, ir, ib, ig, ir), im2 = hn::Mul(im, im);
    // |I - g B|^2 = I.I - (I.B)^2 / B.B and |g B|^2 = (I.B)^2 / B.B; both times B.B.
    const V off = hn::Sub(hn::Mul(ii, mm), im2);
    const V allowed = hn::Max(hn::Mul(chroma2, im2), hn::Mul(noise2, mm));
    const auto is_shade =
        hn::And(hn::And(hn::Ge(im, hn::Mul(darkest, mm)), hn::Lt(im, mm)), hn::Lt(off, allowed));
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(df, is_shade, bytes);
    std::uint64_t lane_bits = 0;
    std::memcpy(&lane_bits, bytes, sizeof bytes);
    bits |= lane_bits << i;
  }
  return bits;
}

// Bit i: pixel i of the 64 (or `count`) from `image` on differs, and isn't shade.
HWY_INLINE std::uint64_t DifferingWord(const std::uint8_t* image, const std::uint8_t* shared_lowest,
                                       std::int16_t shared_width, const std::uint8_t* ranges,
                                       const float* mean, const ShadeRule* shade, std::size_t count) {
  const std::uint8_t* levels = image;
  HWY_ALIGN std::uint8_t rest[kWordBytes];
  if (count < 64) {
    std::memset(rest, 0, sizeof rest);
    std::memcpy(rest, image, count * 3);
    levels = rest;
  }
  if (AreWithin(FarthestAbove(levels, shared_lowest, 0, kWordBytes), shared_width)) return 0;
  const std::uint64_t bits = Differing(levels, ranges);
  if (bits == 0 || shade == nullptr) return bits;
  return bits & ~Shade(bits, levels, mean, *shade);
}

// Sets bit w if a pixel that is looked at in the cell of word w has a channel outside of its range. Cells at
// the end of a row that have fewer than 64 columns are left out. Goes row after row, since the processor
// prefetches what is read in order.
void LookAtCells(const Comparison& all, std::size_t group, std::uint64_t* bits) {
  const std::uint8_t* const shared_lowest = all.shared_lowest.at(group);
  const std::int16_t* const shared_width = all.shared_width.at(group);
  const auto look = [&](std::size_t y, std::size_t begin, std::size_t end) HWY_ATTR {
    const std::uint8_t* const image = all.image.at(y);
    const std::uint8_t* const ranges = all.ranges.at(group) + y % LevelRanges::kSharingRows * kRangeBytes;
    for (std::size_t word = 0; word < all.width / 64; ++word) {
      const std::size_t at = word * kWordBytes;
      const auto farthest = FarthestAbove(image + at, shared_lowest + at, begin, end);
      if (AreWithin(farthest, shared_width[word])) continue;
      if (IsOutside(image + at, ranges + word * kCellBytes, begin, end))
        bits[word / 64] |= std::uint64_t{1} << (word % 64);
    }
  };
  const std::size_t y0 = group * LevelRanges::kSharingRows;
  look(y0, 0, kWordBytes);
  for (std::size_t row = 1; row < all.RowsOfGroup(group); ++row) look(y0 + row, kLookFrom, kLookTo);
}

// Writes a cell's differing pixels; true if there are any.
bool DifferInCell(const Comparison& all, std::size_t group, std::size_t word) {
  const std::size_t x = word * 64, count = std::min<std::size_t>(64, all.width - x);
  const std::uint8_t* const shared_lowest = all.shared_lowest.at(group) + word * kWordBytes;
  const std::int16_t shared_width = all.shared_width.at(group)[word];
  const std::uint8_t* const ranges = all.ranges.at(group) + word * kCellBytes;
  const float* const mean = all.mean.at(group) + word * LevelRanges::kSharingRows * kWordBytes;
  std::uint64_t any = 0;
  for (std::size_t row = 0; row < all.RowsOfGroup(group); ++row) {
    const std::size_t y = group * LevelRanges::kSharingRows + row;
    const std::uint64_t bits =
        DifferingWord(all.image.at(y) + 3 * x, shared_lowest, shared_width, ranges + row * kRangeBytes,
                      mean + row * kWordBytes, all.shade, count);
    all.out.at(y)[word] = bits;
    any |= bits;
  }
  return any != 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace elbowroom::recon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {
namespace {

HWY_EXPORT(LookAtCells);
HWY_EXPORT(DifferInCell);

// The pixels between those that are looked at: rows 1 to 3 of a cell, from pixel 42 to pixel 21 of the next
// one. A region that holds no pixel that is looked at lies within such a gap, so it has at most
// kMostSkippedPx pixels.
constexpr int kSkippedOfRowPx = 64 - 20;
constexpr int kMostSkippedPx = (LevelRanges::kSharingRows - 1) * kSkippedOfRowPx;

constexpr int kStripCells = 30;  // rows of cells

template <typename T>
Rows<const T> RowsOf(const cv::Mat& table) {
  return {table.ptr<T>(), table.step1()};
}

// A picture in cells of 64 pixels by LevelRanges::kSharingRows rows.
class DifferenceSearch {
 public:
  DifferenceSearch(const LevelRanges& ranges, const cv::Mat& image_bgr, const ShadeRule* shade)
      : mask_(image_bgr.cols, image_bgr.rows),
        across_(mask_.words_per_row()),
        down_(static_cast<std::size_t>(image_bgr.rows + LevelRanges::kSharingRows - 1) /
              LevelRanges::kSharingRows) {
    all_.width = static_cast<std::size_t>(image_bgr.cols);
    all_.height = static_cast<std::size_t>(image_bgr.rows);
    all_.image = RowsOf<std::uint8_t>(image_bgr);
    all_.ranges = RowsOf<std::uint8_t>(ranges.levels());
    all_.shared_lowest = RowsOf<std::uint8_t>(ranges.shared_lowest());
    all_.shared_width = RowsOf<std::int16_t>(ranges.shared_width());
    all_.mean = RowsOf<float>(ranges.mean());
    all_.shade = shade;
    all_.out = {mask_.words().data(), mask_.words_per_row()};
  }
  DifferenceSearch(const DifferenceSearch&) = delete;  // all_ points into mask_
  DifferenceSearch& operator=(const DifferenceSearch&) = delete;

  [[nodiscard]] core::BitMask All() && {
    for (std::size_t group = 0; group < down_; ++group)
      for (std::size_t word = 0; word < across_; ++word) (void)Differs(group, word);
    return std::move(mask_);
  }

  // Visits the cells in which a pixel that is looked at differs, and from there on all cells that adjoin one
  // with a differing pixel. So a region that has a pixel that is looked at is found as a whole.
  [[nodiscard]] core::BitMask Large(std::int64_t* skipped_px) && {
    is_known_.assign(down_ * across_, 0);
    const std::vector<std::uint64_t> hits = Look();
    for (std::size_t group = 0; group < down_; ++group) VisitHits(group, hits);
    while (!waiting_.empty()) {
      const Cell cell = waiting_.back();
      waiting_.pop_back();
      Visit(cell);
    }
    *skipped_px = unseen_px_;
    return std::move(mask_);
  }

 private:
  struct Cell {
    std::size_t group, word;
  };

  bool Differs(std::size_t group, std::size_t word) const {
    return HWY_DYNAMIC_DISPATCH(DifferInCell)(all_, group, word);
  }

  [[nodiscard]] std::size_t HitWords() const { return (across_ + 63) / 64; }

  // A row of bits for each row of cells. Strips are looked at in parallel, since reading is all that an empty
  // table costs. They are small, since a thread may start late.
  [[nodiscard]] std::vector<std::uint64_t> Look() const {
    std::vector<std::uint64_t> hits(down_ * HitWords());
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, down_, kStripCells),
        [&](const tbb::blocked_range<std::size_t>& strip) {
          for (std::size_t group = strip.begin(); group < strip.end(); ++group)
            HWY_DYNAMIC_DISPATCH(LookAtCells)(all_, group, hits.data() + group * HitWords());
        },
        tbb::simple_partitioner());
    return hits;
  }

  void VisitHits(std::size_t group, const std::vector<std::uint64_t>& hits) {
    const std::size_t full = all_.width / 64;
    unseen_px_ += UnseenOfCellPx(group) * static_cast<std::int64_t>(full);
    const auto visit = [&](std::size_t word) {
      if (BecomesKnown({group, word})) Visit({group, word});
    };
    for (std::size_t i = 0; i < HitWords(); ++i)
      for (std::uint64_t left = hits[group * HitWords() + i]; left != 0; left &= left - 1)
        visit(64 * i + static_cast<std::size_t>(std::countr_zero(left)));
    if (full < across_) visit(full);  // LookAtCells leaves it out
  }

  [[nodiscard]] std::int64_t UnseenOfCellPx(std::size_t group) const {
    return kSkippedOfRowPx * (static_cast<std::int64_t>(all_.RowsOfGroup(group)) - 1);
  }

  // False if the cell was known before. A known cell is visited, or waits for it.
  [[nodiscard]] bool BecomesKnown(const Cell& cell) {
    return std::exchange(is_known_[cell.group * across_ + cell.word], std::uint8_t{1}) == 0;
  }

  void Visit(const Cell& cell) {
    if (cell.word < all_.width / 64) unseen_px_ -= UnseenOfCellPx(cell.group);
    if (!Differs(cell.group, cell.word)) return;
    const std::size_t left = cell.word - std::min<std::size_t>(cell.word, 1);
    const std::size_t right = std::min(cell.word + 1, across_ - 1);
    for (std::size_t group = cell.group - std::min<std::size_t>(cell.group, 1);
         group <= std::min(cell.group + 1, down_ - 1); ++group)
      for (std::size_t word = left; word <= right; ++word)
        if (BecomesKnown({group, word})) waiting_.push_back({group, word});
  }

  core::BitMask mask_;
  const std::size_t across_, down_;
  Comparison all_;
  std::vector<Cell> waiting_;
  std::vector<std::uint8_t> is_known_;  // for each cell
  std::int64_t unseen_px_ = 0;
};

core::BitMask Differing(const LevelRanges& ranges, const cv::Mat& image_bgr, const ShadeRule* shade,
                        int least_px, std::int64_t* skipped_px) {
  core::Require(
      image_bgr.type() == CV_8UC3 && image_bgr.size() == cv::Size(ranges.width_px(), ranges.height_px()),
      "a picture is 8-bit BGR and of its ranges' size");
  DifferenceSearch search(ranges, image_bgr, shade);
  std::int64_t unseen = 0;
  core::BitMask mask = least_px > kMostSkippedPx ? std::move(search).Large(&unseen) : std::move(search).All();
  if (skipped_px != nullptr) *skipped_px = unseen;
  return mask;
}

}  // namespace

core::BitMask DifferingPixels(const LevelRanges& ranges, const cv::Mat& image_bgr, int least_px,
                              std::int64_t* skipped_px) {
  return Differing(ranges, image_bgr, nullptr, least_px, skipped_px);
}

core::BitMask DifferingPixels(const LevelRanges& ranges, const cv::Mat& image_bgr, const ShadeRule& shade,
                              int least_px, std::int64_t* skipped_px) {
  return Differing(ranges, image_bgr, &shade, least_px, skipped_px);
}

}  // namespace elbowroom::recon
#endif  // HWY_ONCE
