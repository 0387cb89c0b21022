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

// Rows below one another, and the ranges that their pixels share.
struct RowGroup {
  std::size_t count = 0;
  const std::uint8_t* shared_lowest = nullptr;
  const std::int16_t* shared_width = nullptr;
  const std::uint8_t* image[LevelRanges::kSharingRows];
  const std::uint8_t* ranges[LevelRanges::kSharingRows];
  const float* mean[LevelRanges::kSharingRows];
  std::uint64_t* out[LevelRanges::kSharingRows];
};

}  // namespace
}  // namespace elbowroom::recon
#endif

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon {
namespace HWY_NAMESPACE {  // NOLINT(google-build-namespaces)
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kWordBytes = 192;  // of 64 pixels
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

// The same for the `count` pixels that are left at the end of a row.
HWY_NOINLINE std::uint64_t ShadeAtEnd(std::uint64_t candidates, const std::uint8_t* image, const float* mean,
                                      std::size_t count, const ShadeRule& rule) {
  HWY_ALIGN std::uint8_t levels[kWordBytes] = {};
  HWY_ALIGN float means[kWordBytes] = {};
  std::memcpy(levels, image, count * 3);
  std::memcpy(means, mean, count * 3 * sizeof(float));
  return Shade(candidates, levels, means, rule);
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
  return bits &
         ~(count == 64 ? Shade(bits, image, mean, *shade) : ShadeAtEnd(bits, image, mean, count, *shade));
}

// Sets bit w if a pixel that is looked at in the cell of word w has a channel outside of its range. Cells at
// the end of a row that have fewer than 64 columns are left out. Goes row after row, since the processor
// prefetches what is read in order.
void LookAtCells(const RowGroup& rows, std::size_t width, std::uint64_t* bits) {
  const auto look = [&](std::size_t row, std::size_t begin, std::size_t end) HWY_ATTR {
    for (std::size_t word = 0; word < width / 64; ++word) {
      const std::size_t at = word * kWordBytes;
      const auto farthest = FarthestAbove(rows.image[row] + at, rows.shared_lowest + at, begin, end);
      if (AreWithin(farthest, rows.shared_width[word])) continue;
      if (IsOutside(rows.image[row] + at, rows.ranges[row] + 2 * at, begin, end))
        bits[word / 64] |= std::uint64_t{1} << (word % 64);
    }
  };
  look(0, 0, kWordBytes);
  for (std::size_t row = 1; row < rows.count; ++row) look(row, kLookFrom, kLookTo);
}

// Writes a cell's differing pixels; true if there are any.
bool DifferInCell(const RowGroup& rows, std::size_t word, std::size_t width, const ShadeRule* shade) {
  const std::size_t x = word * 64, count = std::min<std::size_t>(64, width - x);
  std::uint64_t any = 0;
  for (std::size_t i = 0; i < rows.count; ++i) {
    const float* mean = shade != nullptr ? rows.mean[i] + 3 * x : nullptr;
    const std::uint64_t bits =
        DifferingWord(rows.image[i] + 3 * x, rows.shared_lowest + word * kWordBytes, rows.shared_width[word],
                      rows.ranges[i] + word * 2 * kWordBytes, mean, shade, count);
    rows.out[i][word] = bits;
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

// A picture in cells of 64 pixels by LevelRanges::kSharingRows rows.
class DifferenceSearch {
 public:
  DifferenceSearch(const LevelRanges& ranges, const cv::Mat& image_bgr, const cv::Mat& mean_bgr,
                   const ShadeRule* shade)
      : ranges_(ranges),
        image_bgr_(image_bgr),
        mean_bgr_(mean_bgr),
        shade_(shade),
        mask_(image_bgr.cols, image_bgr.rows),
        across_(static_cast<int>(mask_.words_per_row())),
        down_((image_bgr.rows + LevelRanges::kSharingRows - 1) / LevelRanges::kSharingRows) {}

  [[nodiscard]] core::BitMask All() && {
    for (int group = 0; group < down_; ++group) {
      const RowGroup rows = RowsOf(group);
      for (int word = 0; word < across_; ++word) (void)Differs(rows, word);
    }
    return std::move(mask_);
  }

  // Visits the cells in which a pixel that is looked at differs, and from there on all cells that adjoin one
  // with a differing pixel. So a region that has a pixel that is looked at is found as a whole.
  [[nodiscard]] core::BitMask Large(std::int64_t* skipped_px) && {
    is_known_.assign(static_cast<std::size_t>(down_ * across_), 0);
    const std::vector<std::uint64_t> hits = Look();
    for (int group = 0; group < down_; ++group) VisitHits(group, hits);
    while (!waiting_.empty()) {
      const auto [group, word] = waiting_.back();
      waiting_.pop_back();
      Visit(RowsOf(group), group, word);
    }
    *skipped_px = unseen_px_;
    return std::move(mask_);
  }

 private:
  struct Cell {
    int group, word;
  };

  [[nodiscard]] RowGroup RowsOf(int group) {
    const int y0 = group * LevelRanges::kSharingRows;
    RowGroup rows;
    rows.count = static_cast<std::size_t>(std::min(LevelRanges::kSharingRows, image_bgr_.rows - y0));
    rows.shared_lowest = ranges_.shared_lowest(y0);
    rows.shared_width = ranges_.shared_width(y0);
    for (std::size_t i = 0; i < rows.count; ++i) {
      const int y = y0 + static_cast<int>(i);
      rows.image[i] = image_bgr_.ptr<std::uint8_t>(y);
      rows.ranges[i] = ranges_.row(y);
      rows.mean[i] = shade_ != nullptr ? mean_bgr_.ptr<float>(y) : nullptr;
      rows.out[i] = mask_.words().data() + static_cast<std::size_t>(y) * mask_.words_per_row();
    }
    return rows;
  }

  bool Differs(const RowGroup& rows, int word) {
    return HWY_DYNAMIC_DISPATCH(DifferInCell)(rows, static_cast<std::size_t>(word),
                                              static_cast<std::size_t>(image_bgr_.cols), shade_);
  }

  [[nodiscard]] std::size_t HitWords() const { return static_cast<std::size_t>(across_ + 63) / 64; }

  // A row of bits for each row of cells. Strips are looked at in parallel, since reading is all that an empty
  // table costs. They are small, since a thread may start late.
  [[nodiscard]] std::vector<std::uint64_t> Look() {
    std::vector<std::uint64_t> hits(static_cast<std::size_t>(down_) * HitWords());
    tbb::parallel_for(
        tbb::blocked_range<int>(0, down_, kStripCells),
        [&](const tbb::blocked_range<int>& strip) {
          for (int group = strip.begin(); group < strip.end(); ++group) HWY_DYNAMIC_DISPATCH(LookAtCells)
          (RowsOf(group), static_cast<std::size_t>(image_bgr_.cols),
           hits.data() + static_cast<std::size_t>(group) * HitWords());
        },
        tbb::simple_partitioner());
    return hits;
  }

  void VisitHits(int group, const std::vector<std::uint64_t>& hits) {
    const RowGroup rows = RowsOf(group);
    unseen_px_ += UnseenOfCellPx(rows) * (image_bgr_.cols / 64);
    for (std::size_t i = 0; i < HitWords(); ++i)
      for (std::uint64_t left = hits[static_cast<std::size_t>(group) * HitWords() + i]; left != 0;
           left &= left - 1)
        Visit(rows, group, static_cast<int>(64 * i) + std::countr_zero(left));
    if (image_bgr_.cols % 64 != 0) Visit(rows, group, across_ - 1);  // LookAtCells leaves it out
  }

  static std::int64_t UnseenOfCellPx(const RowGroup& rows) {
    return kSkippedOfRowPx * (static_cast<std::int64_t>(rows.count) - 1);
  }

  void Visit(const RowGroup& rows, int group, int word) {
    std::uint8_t& is_known = is_known_[static_cast<std::size_t>(group * across_ + word)];
    if (is_known != 0) return;
    is_known = 1;
    if (word < image_bgr_.cols / 64) unseen_px_ -= UnseenOfCellPx(rows);
    if (!Differs(rows, word)) return;
    for (int y = std::max(group - 1, 0); y <= std::min(group + 1, down_ - 1); ++y)
      for (int x = std::max(word - 1, 0); x <= std::min(word + 1, across_ - 1); ++x)
        if (is_known_[static_cast<std::size_t>(y * across_ + x)] == 0) waiting_.push_back({y, x});
  }

  const LevelRanges& ranges_;
  const cv::Mat& image_bgr_;
  const cv::Mat& mean_bgr_;
  const ShadeRule* const shade_;
  core::BitMask mask_;
  const int across_, down_;
  std::vector<Cell> waiting_;  // some more than once
  std::vector<std::uint8_t> is_known_;
  std::int64_t unseen_px_ = 0;
};

core::BitMask Differing(const LevelRanges& ranges, const cv::Mat& image_bgr, const cv::Mat& mean_bgr,
                        const ShadeRule* shade, int least_px, std::int64_t* skipped_px) {
  core::Require(
      image_bgr.type() == CV_8UC3 && image_bgr.size() == cv::Size(ranges.width_px(), ranges.height_px()),
      "a picture is 8-bit BGR and of its ranges' size");
  DifferenceSearch search(ranges, image_bgr, mean_bgr, shade);
  std::int64_t unseen = 0;
  core::BitMask mask = least_px > kMostSkippedPx ? std::move(search).Large(&unseen) : std::move(search).All();
  if (skipped_px != nullptr) *skipped_px = unseen;
  return mask;
}

}  // namespace

core::BitMask DifferingPixels(const LevelRanges& ranges, const cv::Mat& image_bgr, int least_px,
                              std::int64_t* skipped_px) {
  return Differing(ranges, image_bgr, {}, nullptr, least_px, skipped_px);
}

core::BitMask DifferingPixels(const LevelRanges& ranges, const cv::Mat& image_bgr, const cv::Mat& mean_bgr,
                              const ShadeRule& shade, int least_px, std::int64_t* skipped_px) {
  core::Require(mean_bgr.type() == CV_32FC3 && mean_bgr.size() == image_bgr.size(),
                "a background's mean is CV_32FC3 and of the picture's size");
  return Differing(ranges, image_bgr, mean_bgr, &shade, least_px, skipped_px);
}

}  // namespace elbowroom::recon
#endif  // HWY_ONCE
