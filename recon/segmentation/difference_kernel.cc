#include "recon/segmentation/difference_kernel.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "core/error.h"
#include "recon/segmentation/cell_search.h"

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

// A change of exposure for each level of 64 pixels, and for each channel.
struct ExposureOfWord {
  alignas(64) std::array<std::int16_t, 192> gain{}, offset{};  // as FixedExposure
  std::array<float, 3> gain_bgr{}, offset_bgr{};
};

// A picture and ranges that follow its exposure.
struct FollowedComparison {
  Comparison picture;  // without ranges
  Rows<const std::int16_t> ranges, shared;
  const ExposureOfWord* exposure = nullptr;
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
static_assert(kLookFrom <= 3 * kLookFromPx && 3 * kLookToPx <= kLookTo);

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

// Bit i: pixel i of 64 is shade; pixels that aren't candidates needn't be decided. `follow` changes a channel
// of the mean. No contraction to fused multiply-add, so that every target rounds alike.
template <class Follow>
HWY_INLINE std::uint64_t Shade(std::uint64_t candidates, const std::uint8_t* image, const float* mean,
                               const ShadeRule& rule, const Follow& follow) {
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
    mb = follow(mb, 0), mg = follow(mg, 1), mr = follow(mr, 2);
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

struct AsMeasured {
  template <class V>
  HWY_INLINE V operator()(V mean, std::size_t /*channel*/) const {
    return mean;
  }
};

// gain * mean + offset within 0..255.
struct AsFollowed {
  const ExposureOfWord& exposure;

  template <class V>
  HWY_INLINE V operator()(V mean, std::size_t channel) const {
    const hn::DFromV<V> df;
    const V changed = hn::Add(hn::Mul(mean, hn::Set(df, exposure.gain_bgr[channel])),
                              hn::Set(df, exposure.offset_bgr[channel]));
    return hn::Min(hn::Max(changed, hn::Zero(df)), hn::Set(df, 255.0F));
  }
};

// The levels of a row's pixels, or of the last `count` of them, with zeros after these.
HWY_INLINE const std::uint8_t* WholeWord(const std::uint8_t* image, std::size_t count, std::uint8_t* rest) {
  if (count >= 64) return image;
  std::memset(rest, 0, kWordBytes);
  std::memcpy(rest, image, count * 3);
  return rest;
}

// Bit i: pixel i of the 64 (or `count`) from `image` on differs, and isn't shade.
HWY_INLINE std::uint64_t DifferingWord(const std::uint8_t* image, const std::uint8_t* shared_lowest,
                                       std::int16_t shared_width, const std::uint8_t* ranges,
                                       const float* mean, const ShadeRule* shade, std::size_t count) {
  HWY_ALIGN std::uint8_t rest[kWordBytes];
  const std::uint8_t* const levels = WholeWord(image, count, rest);
  if (AreWithin(FarthestAbove(levels, shared_lowest, 0, kWordBytes), shared_width)) return 0;
  const std::uint64_t bits = Differing(levels, ranges);
  if (bits == 0 || shade == nullptr) return bits;
  return bits & ~Shade(bits, levels, mean, *shade, AsMeasured());
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

// Ranges [begin, end) of 64 pixels after the change, as bytes: the whole levels from gain * lowest + offset
// to gain * highest + offset. With levels in 1 / 64 and a gain in 1 / 2^13, the rounded 15-bit product is in
// sixteenths of a level, as the offset is. Each step keeps the order of levels.
HWY_INLINE void Follow(const std::int16_t* ranges, const ExposureOfWord& exposure, std::size_t begin,
                       std::size_t end, std::uint8_t* bytes) {
  constexpr int kFraction = FixedExposure::kOffsetBits;
  static_assert(FollowedRanges::kLevelBits + FixedExposure::kGainBits - 15 == kFraction);
  const hn::CappedTag<std::int16_t, 32> d;
  const hn::Rebind<std::uint8_t, decltype(d)> du;
  const auto up = hn::Set(d, (1 << kFraction) - 1);
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto gain = hn::Load(d, exposure.gain.data() + i), offset = hn::Load(d, exposure.offset.data() + i);
    const auto change = [&](const std::int16_t* level) HWY_ATTR {
      return hn::SaturatedAdd(hn::MulFixedPoint15(hn::Load(d, level), gain), offset);
    };
    const auto lowest = hn::ShiftRight<kFraction>(hn::SaturatedAdd(change(ranges + i), up));
    const auto highest = hn::ShiftRight<kFraction>(change(ranges + kWordBytes + i));
    hn::Store(hn::DemoteTo(du, lowest), du, bytes + i);
    hn::Store(hn::DemoteTo(du, highest), du, bytes + kWordBytes + i);
  }
}

// As LookAtCells.
void LookAtFollowedCells(const FollowedComparison& all, std::size_t group, std::uint64_t* bits) {
  const std::int16_t* const ranges = all.ranges.at(group);
  const std::int16_t* const shared = all.shared.at(group);
  const std::size_t y0 = group * LevelRanges::kSharingRows, rows = all.picture.RowsOfGroup(group);
  HWY_ALIGN std::uint8_t common[kRangeBytes], own[kRangeBytes];
  for (std::size_t word = 0; word < all.picture.width / 64; ++word) {
    Follow(shared + word * kRangeBytes, *all.exposure, 0, kWordBytes, common);
    const auto is_outside = [&](std::size_t row, std::size_t begin, std::size_t end) HWY_ATTR {
      const std::uint8_t* const image = all.picture.image.at(y0 + row) + word * kWordBytes;
      if (!IsOutside(image, common, begin, end)) return false;
      Follow(ranges + word * kCellBytes + row * kRangeBytes, *all.exposure, begin, end, own);
      return IsOutside(image, own, begin, end);
    };
    bool differs = is_outside(0, 0, kWordBytes);
    for (std::size_t row = 1; row < rows && !differs; ++row) differs = is_outside(row, kLookFrom, kLookTo);
    if (differs) bits[word / 64] |= std::uint64_t{1} << (word % 64);
  }
}

// As DifferInCell.
bool DifferInFollowedCell(const FollowedComparison& all, std::size_t group, std::size_t word) {
  const Comparison& picture = all.picture;
  const std::size_t x = word * 64, count = std::min<std::size_t>(64, picture.width - x);
  const std::int16_t* const ranges = all.ranges.at(group) + word * kCellBytes;
  const float* const mean = picture.mean.at(group) + word * LevelRanges::kSharingRows * kWordBytes;
  HWY_ALIGN std::uint8_t common[kRangeBytes], own[kRangeBytes], rest[kWordBytes];
  Follow(all.shared.at(group) + word * kRangeBytes, *all.exposure, 0, kWordBytes, common);
  std::uint64_t any = 0;
  for (std::size_t row = 0; row < picture.RowsOfGroup(group); ++row) {
    const std::size_t y = group * LevelRanges::kSharingRows + row;
    const std::uint8_t* const levels = WholeWord(picture.image.at(y) + 3 * x, count, rest);
    std::uint64_t bits = 0;
    if (IsOutside(levels, common, 0, kWordBytes)) {
      Follow(ranges + row * kRangeBytes, *all.exposure, 0, kWordBytes, own);
      bits = Differing(levels, own);
      if (bits != 0 && picture.shade != nullptr)
        bits &= ~Shade(bits, levels, mean + row * kWordBytes, *picture.shade, AsFollowed{*all.exposure});
    }
    picture.out.at(y)[word] = bits;
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
HWY_EXPORT(LookAtFollowedCells);
HWY_EXPORT(DifferInFollowedCell);

template <typename T>
Rows<const T> RowsOf(const cv::Mat& table) {
  return {table.ptr<T>(), table.step1()};
}

// The part that is alike for all tables of the empty scene.
template <class Table>
Comparison ComparisonWith(const Table& table, const cv::Mat& image_bgr, const ShadeRule* shade,
                          core::BitMask* mask) {
  core::Require(
      image_bgr.type() == CV_8UC3 && image_bgr.size() == cv::Size(table.width_px(), table.height_px()),
      "a picture is 8-bit BGR and of its ranges' size");
  *mask = core::BitMask(image_bgr.cols, image_bgr.rows);
  Comparison all;
  all.width = static_cast<std::size_t>(image_bgr.cols);
  all.height = static_cast<std::size_t>(image_bgr.rows);
  all.image = RowsOf<std::uint8_t>(image_bgr);
  all.mean = RowsOf<float>(table.mean());
  all.shade = shade;
  all.out = {mask->words().data(), mask->words_per_row()};
  return all;
}

// `kernel`: the comparison of cells of the picture, of which `all` holds the size.
void Search(const Comparison& all, const CellKernel& kernel, int least_px, std::int64_t* skipped_px) {
  const std::int64_t unseen_px = SearchCells(all.width, all.height, kernel, least_px);
  if (skipped_px != nullptr) *skipped_px = unseen_px;
}

core::BitMask Differing(const LevelRanges& ranges, const cv::Mat& image_bgr, const ShadeRule* shade,
                        int least_px, std::int64_t* skipped_px) {
  core::BitMask mask;
  Comparison all = ComparisonWith(ranges, image_bgr, shade, &mask);
  all.ranges = RowsOf<std::uint8_t>(ranges.levels());
  all.shared_lowest = RowsOf<std::uint8_t>(ranges.shared_lowest());
  all.shared_width = RowsOf<std::int16_t>(ranges.shared_width());
  const CellKernel kernel{[&](std::size_t group, std::uint64_t* bits) {
                            HWY_DYNAMIC_DISPATCH(LookAtCells)(all, group, bits);
                          },
                          [&](std::size_t group, std::size_t word) {
                            return HWY_DYNAMIC_DISPATCH(DifferInCell)(all, group, word);
                          }};
  Search(all, kernel, least_px, skipped_px);
  return mask;
}

// The change of exposure for each level of 64 pixels.
ExposureOfWord ForWord(const FixedExposure& exposure) {
  ExposureOfWord word;
  for (std::size_t i = 0; i < word.gain.size(); ++i) {
    word.gain[i] = exposure.gain[i % 3];
    word.offset[i] = exposure.offset[i % 3];
  }
  for (std::size_t c = 0; c < 3; ++c) {
    word.gain_bgr[c] = static_cast<float>(exposure.Gain(c));
    word.offset_bgr[c] = static_cast<float>(exposure.OffsetLevels(c));
  }
  return word;
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

core::BitMask DifferingPixels(const FollowedRanges& ranges, const FixedExposure& exposure,
                              const cv::Mat& image_bgr, const ShadeRule* shade, int least_px,
                              std::int64_t* skipped_px) {
  core::BitMask mask;
  const ExposureOfWord of_word = ForWord(exposure);
  FollowedComparison all{ComparisonWith(ranges, image_bgr, shade, &mask),
                         RowsOf<std::int16_t>(ranges.levels()), RowsOf<std::int16_t>(ranges.shared()),
                         &of_word};
  const CellKernel kernel{[&](std::size_t group, std::uint64_t* bits) {
                            HWY_DYNAMIC_DISPATCH(LookAtFollowedCells)(all, group, bits);
                          },
                          [&](std::size_t group, std::size_t word) {
                            return HWY_DYNAMIC_DISPATCH(DifferInFollowedCell)(all, group, word);
                          }};
  Search(all.picture, kernel, least_px, skipped_px);
  return mask;
}

}  // namespace elbowroom::recon
#endif  // HWY_ONCE
