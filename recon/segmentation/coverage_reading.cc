#include "recon/segmentation/coverage_reading.h"

#include <algorithm>
#include <cstring>

#include "recon/segmentation/coverage_steps.h"

// Highway compiles what stands between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE once a target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/segmentation/coverage_reading.cc"  // NOLINT(bugprone-macro-parentheses)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef ELBOWROOM_RECON_COVERAGE_READING_LABELS
#define ELBOWROOM_RECON_COVERAGE_READING_LABELS
namespace elbowroom::recon {
namespace {

// The labels of 5 x 5 pixels, five bits a row from the lowest bit on; the pixel itself is bit 12. Those
// beyond the picture repeat its edge. Slow, for the few pixels near the edge.
std::uint32_t LabelsAtEdge(const core::BitMask& mask, int x, int y) {
  std::uint32_t labels = 0;
  for (int i = 0; i < 25; ++i) {
    const int u = std::clamp(x + i % 5 - 2, 0, mask.width_px() - 1);
    const int v = std::clamp(y + i / 5 - 2, 0, mask.height_px() - 1);
    labels |= std::uint32_t{mask.At(u, v)} << static_cast<unsigned>(i);
  }
  return labels;
}

}  // namespace
}  // namespace elbowroom::recon
#endif

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon {
namespace HWY_NAMESPACE {  // NOLINT(google-build-namespaces)
namespace hn = hwy::HWY_NAMESPACE;

using Ints = hn::CappedTag<std::int32_t, CoverageSamples::kBatch>;
using Bits = hn::Rebind<std::uint32_t, Ints>;
using VI = hn::Vec<Ints>;
using VB = hn::Vec<Bits>;

HWY_INLINE VI SetInt(int value) { return hn::Set(Ints(), value); }
HWY_INLINE VB SetBits(std::uint32_t value) { return hn::Set(Bits(), value); }
HWY_INLINE VI AsInts(VB bits) { return hn::BitCast(Ints(), bits); }
HWY_INLINE VB AsBits(VI ints) { return hn::BitCast(Bits(), ints); }
// All ones where the bits of `flag` are set.
HWY_INLINE VB Where(VB bits, std::uint32_t flag) {
  return AsBits(hn::VecFromMask(Ints(), hn::Ne(AsInts(hn::And(bits, SetBits(flag))), hn::Zero(Ints()))));
}

struct Places {
  VI x, y;
};

// Packed means as they are, and after a change of exposure, as WithExposure has it.
struct MeanAsMeasured {
  explicit MeanAsMeasured(const CoveragePicture& /*picture*/) {}
  HWY_INLINE VB operator()(VB packed) const { return packed; }
};
struct MeanAsFollowed {
  explicit MeanAsFollowed(const CoveragePicture& picture) : exposure(*picture.exposure) {}
  HWY_INLINE VB operator()(VB packed) const {
    return hn::Or(Channel<0>(packed), hn::Or(Channel<1>(packed), Channel<2>(packed)));
  }
  template <std::size_t channel>
  HWY_INLINE VB Channel(VB packed) const {
    const VI quarters = AsInts(hn::And(hn::ShiftRight<10 * channel>(packed), SetBits(1023U)));
    const VI offset =
        SetInt(exposure.offset[channel] * (1 << kQuarterOffsetShift) + (1 << (FixedExposure::kGainBits - 1)));
    const VI sum = hn::Add(hn::Mul(quarters, SetInt(exposure.gain[channel])), offset);
    const VI rounded = hn::ShiftRight<FixedExposure::kGainBits>(sum);
    return hn::ShiftLeft<10 * channel>(AsBits(hn::Min(hn::Max(rounded, SetInt(0)), SetInt(kMostQuarters))));
  }
  const FixedExposure& exposure;
};

// Numbers that are the same for all pixels of a picture.
template <class MeanRule>
class Reader {
 public:
  explicit Reader(const CoveragePicture& picture)
      : picture_(picture),
        mean_rule_(picture),
        width_(picture.detected->width_px()),
        height_(picture.detected->height_px()),
        row_bytes_(static_cast<int>(picture.detected->words_per_row() * 8)),
        labels_(reinterpret_cast<const std::int32_t*>(picture.detected->words().data())),
        steps_(reinterpret_cast<const std::int32_t*>(AllSteps().data())) {}

  // Four bytes are read where a pixel has three. At the picture's last pixel they begin a byte earlier, so
  // that they don't go past its end. A picture with a boundary has at least two pixels, so six bytes.
  [[nodiscard]] HWY_INLINE VB Image(const Places& at) const {
    const VI from = hn::Add(hn::Mul(at.y, SetInt(picture_.image_stride)), hn::Mul(at.x, SetInt(3)));
    const VI last = SetInt((height_ - 1) * picture_.image_stride + 3 * width_ - 4);
    const VB four = AsBits(
        hn::GatherOffset(Ints(), reinterpret_cast<const std::int32_t*>(picture_.image), hn::Min(from, last)));
    const VB is_last = AsBits(hn::VecFromMask(Ints(), hn::Gt(from, last)));
    return hn::And(hn::Or(hn::And(is_last, hn::ShiftRight<8>(four)), hn::AndNot(is_last, four)),
                   SetBits(0xffffffU));
  }

  [[nodiscard]] HWY_INLINE VB Mean(const Places& at) const {
    const VI index = hn::Add(hn::Mul(at.y, SetInt(picture_.mean_stride)), at.x);
    return mean_rule_(
        AsBits(hn::GatherIndex(Ints(), reinterpret_cast<const std::int32_t*>(picture_.mean), index)));
  }

  // All ones where a pixel is object.
  [[nodiscard]] HWY_INLINE VB IsObject(const Places& at) const {
    const VI word = hn::Add(hn::Mul(at.y, SetInt(row_bytes_ / 4)), hn::ShiftRight<5>(at.x));
    const VB labels = AsBits(hn::GatherIndex(Ints(), labels_, word));
    return Where(hn::Shr(labels, AsBits(hn::And(at.x, SetInt(31)))), 1U);
  }

  // All ones where a place is a pixel of the picture.
  [[nodiscard]] HWY_INLINE VB IsPixel(const Places& at) const {
    return IsBetween(at, SetInt(-1), SetInt(width_), SetInt(height_));
  }

  // The labels as LabelsAtEdge has them. A row's five bits begin anywhere in a byte, so they are within the
  // four bytes from there on; these are taken from within the row.
  [[nodiscard]] HWY_INLINE VB Labels(const Places& at) const {
    const VB is_inside = IsBetween(at, SetInt(1), SetInt(width_ - 2), SetInt(height_ - 2));
    if (!hn::AllTrue(Bits(), hn::Ne(is_inside, hn::Zero(Bits())))) return LabelsOneByOne(at);
    const VI first = hn::Sub(at.x, SetInt(2));
    const VI byte = hn::Min(hn::ShiftRight<3>(first), SetInt(row_bytes_ - 4));
    const VB shift = AsBits(hn::Sub(first, hn::ShiftLeft<3>(byte)));
    const auto five = [&](int dy) HWY_ATTR {
      const VI row = hn::Mul(hn::Add(at.y, SetInt(dy)), SetInt(row_bytes_));
      const VB four_bytes = AsBits(hn::GatherOffset(Ints(), labels_, hn::Add(row, byte)));
      return hn::And(hn::Shr(four_bytes, shift), SetBits(31U));
    };
    return hn::Or(
        hn::Or(five(-2), hn::ShiftLeft<5>(five(-1))),
        hn::Or(hn::Or(hn::ShiftLeft<10>(five(0)), hn::ShiftLeft<15>(five(1))), hn::ShiftLeft<20>(five(2))));
  }

  // The steps that belong to 5 x 5 labels. Sums of columns and of rows are taken in five fields of five bits
  // each, one a row, which never overflow: a multiplication by kOnes adds all fields up in the highest one.
  [[nodiscard]] HWY_INLINE VB Steps(VB labels) const {
    constexpr std::uint32_t kOnes = 0x108421U;  // one in each field
    const VB ones = SetBits(kOnes);
    const VB c0 = hn::And(labels, ones), c1 = hn::And(hn::ShiftRight<1>(labels), ones),
             c2 = hn::And(hn::ShiftRight<2>(labels), ones), c3 = hn::And(hn::ShiftRight<3>(labels), ones),
             c4 = hn::And(hn::ShiftRight<4>(labels), ones);
    // Three is added to each row's moment, so that it is from 0 to 6: in all 15, which is kMostMoment.
    const VB moments =
        hn::Sub(hn::Add(hn::Add(c3, hn::Add(c4, c4)), SetBits(3 * kOnes)), hn::Add(c1, hn::Add(c0, c0)));
    const VB x = hn::And(hn::ShiftRight<20>(hn::Mul(moments, ones)), SetBits(31U));
    const VB counts = hn::Add(hn::Add(c0, c1), hn::Add(c2, hn::Add(c3, c4)));
    const auto row = [&](VB shifted) HWY_ATTR { return hn::And(shifted, SetBits(31U)); };
    const VB below = hn::Add(row(hn::ShiftRight<15>(counts)), hn::ShiftLeft<1>(hn::ShiftRight<20>(counts)));
    const VB above = hn::Add(row(hn::ShiftRight<5>(counts)), hn::ShiftLeft<1>(row(counts)));
    const VB y = hn::Sub(hn::Add(below, SetBits(kMostMoment)), above);
    return AsBits(hn::GatherIndex(Ints(), steps_, AsInts(hn::Add(hn::Mul(y, SetBits(kMoments)), x))));
  }

 private:
  [[nodiscard]] static HWY_INLINE VB IsBetween(const Places& at, VI below, VI right, VI bottom) {
    const auto along_x = hn::And(hn::Gt(at.x, below), hn::Lt(at.x, right));
    const auto along_y = hn::And(hn::Gt(at.y, below), hn::Lt(at.y, bottom));
    return AsBits(hn::VecFromMask(Ints(), hn::And(along_x, along_y)));
  }

  [[nodiscard]] HWY_NOINLINE VB LabelsOneByOne(const Places& at) const {
    HWY_ALIGN std::int32_t x[CoverageSamples::kBatch], y[CoverageSamples::kBatch];
    HWY_ALIGN std::uint32_t labels[CoverageSamples::kBatch];
    hn::Store(at.x, Ints(), x), hn::Store(at.y, Ints(), y);
    for (std::size_t i = 0; i < hn::Lanes(Ints()); ++i)
      labels[i] = LabelsAtEdge(*picture_.detected, x[i], y[i]);
    return hn::Load(Bits(), labels);
  }

  const CoveragePicture& picture_;
  MeanRule mean_rule_;
  int width_, height_, row_bytes_;
  const std::int32_t* labels_;
  const std::int32_t* steps_;
};

// Step `index` (0 to 2) of packed steps: moved up until its highest bit is the sign, then back.
template <int index>
HWY_INLINE Places Step(VB steps) {
  const auto field = [&](VB up) HWY_ATTR { return hn::ShiftRight<32 - kStepBits>(AsInts(up)); };
  return {field(hn::ShiftLeft<32 - kStepBits*(2 * index + 1)>(steps)),
          field(hn::ShiftLeft<32 - kStepBits*(2 * index + 2)>(steps))};
}
HWY_INLINE Places Plus(const Places& at, const Places& by) {
  return {hn::Add(at.x, by.x), hn::Add(at.y, by.y)};
}
HWY_INLINE Places Minus(const Places& at, const Places& by) {
  return {hn::Sub(at.x, by.x), hn::Sub(at.y, by.y)};
}
HWY_INLINE VI Choose(VB is_first, VI first, VI second) {
  return AsInts(hn::Or(hn::And(is_first, AsBits(first)), hn::AndNot(is_first, AsBits(second))));
}
HWY_INLINE Places Choose(VB is_first, const Places& first, const Places& second) {
  return {Choose(is_first, first.x, second.x), Choose(is_first, first.y, second.y)};
}

template <class Reader>
HWY_INLINE void ReadPair(const Reader& reader, const Places& at, VB kept, std::size_t i,
                         CoverageSamples::Pair* pair) {
  hn::Store(hn::And(reader.Image(at), kept), Bits(), pair->image.data() + i);
  hn::Store(hn::And(reader.Mean(at), kept), Bits(), pair->mean.data() + i);
}

// One vector of places, from number i of the batch on. Returns ones where there is no interior.
template <class Reader>
HWY_INLINE VB ReadVector(const Reader& reader, const Places& place, std::size_t i, CoverageSamples* samples) {
  const VB ones = SetBits(~0U);
  const VB labels = reader.Labels(place), steps = reader.Steps(labels);
  ReadPair(reader, place, ones, i, &samples->here);
  // The neighbours across the boundary, along the row or column that crosses it more steeply. Past the
  // picture's edge the pixel itself is taken.
  const VB is_along_x = Where(steps, kIsAlongX);
  const Places axis{AsInts(hn::And(is_along_x, SetBits(1U))), AsInts(hn::AndNot(is_along_x, SetBits(1U)))};
  const Places before = Minus(place, axis), after = Plus(place, axis);
  ReadPair(reader, Choose(reader.IsPixel(before), before, place), ones, i, &samples->before);
  ReadPair(reader, Choose(reader.IsPixel(after), after, place), ones, i, &samples->after);
  const Places first = Step<0>(steps), second = Step<1>(steps), third = Step<2>(steps);
  // The light is measured at two background pixels outwards. `kept` is all ones as long as they are
  // background pixels of the picture, and zero, which makes them black, from the first that isn't; without a
  // direction it is zero from the start.
  VB kept = Where(steps, kHasDirection);
  const auto read_light = [&](const Places& step, CoverageSamples::Pair* pair) HWY_ATTR {
    const Places outwards = Minus(place, step);
    const VB is_pixel = reader.IsPixel(outwards);
    const Places at = Choose(is_pixel, outwards, place);
    kept = hn::And(kept, hn::AndNot(reader.IsObject(at), is_pixel));
    ReadPair(reader, at, kept, i, pair);
  };
  read_light(second, samples->light.data());
  read_light(third, samples->light.data() + 1);
  // The object's colour is taken one and two steps inwards of the boundary: a background pixel's first step
  // only leads there.
  const VB is_object = Where(labels, 1U << 12U);
  const Places inwards = Plus(place, Choose(is_object, first, second));
  const Places further = Plus(place, Choose(is_object, second, third));
  const VB is_inwards = reader.IsPixel(inwards), is_further = reader.IsPixel(further);
  const Places near = Choose(is_inwards, inwards, place), far = Choose(is_further, further, place);
  const VB has_interior = hn::And(hn::And(Where(steps, kHasDirection), is_inwards), reader.IsObject(near));
  const VB near_color = reader.Image(near);
  const VB has_far = hn::And(is_further, reader.IsObject(far));
  hn::Store(near_color, Bits(), samples->near.data() + i);
  hn::Store(hn::Or(hn::And(has_far, reader.Image(far)), hn::AndNot(has_far, near_color)), Bits(),
            samples->far.data() + i);
  return hn::Not(has_interior);
}

template <class MeanRule>
HWY_INLINE std::uint64_t ReadBatchBy(const CoveragePicture& picture, const PixelPlace* places,
                                     std::size_t count, CoverageSamples* samples) {
  static_assert(sizeof(PixelPlace) == 2 * sizeof(std::int32_t));
  const Reader<MeanRule> reader(picture);
  std::uint64_t without_interior = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(Ints())) {
    Places place;
    hn::LoadInterleaved2(Ints(), &places[i].x, place.x, place.y);
    const VB alone = ReadVector(reader, place, i, samples);
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Bits(), hn::Ne(alone, hn::Zero(Bits())), bytes);
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bytes);
    without_interior |= bits << i;
  }
  return without_interior;
}

std::uint64_t ReadBatch(const CoveragePicture& picture, const PixelPlace* places, std::size_t count,
                        CoverageSamples* samples) {
  return ReadBatchBy<MeanAsMeasured>(picture, places, count, samples);
}
std::uint64_t ReadFollowedBatch(const CoveragePicture& picture, const PixelPlace* places, std::size_t count,
                                CoverageSamples* samples) {
  return ReadBatchBy<MeanAsFollowed>(picture, places, count, samples);
}

}  // namespace HWY_NAMESPACE
}  // namespace elbowroom::recon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {
namespace {

HWY_EXPORT(ReadBatch);
HWY_EXPORT(ReadFollowedBatch);

}  // namespace

std::uint64_t ReadSamples(const CoveragePicture& picture, const PixelPlace* places, std::size_t count,
                          CoverageSamples* samples) {
  const std::uint64_t bits = picture.exposure == nullptr
                                 ? HWY_DYNAMIC_DISPATCH(ReadBatch)(picture, places, count, samples)
                                 : HWY_DYNAMIC_DISPATCH(ReadFollowedBatch)(picture, places, count, samples);
  return count < 64 ? bits & ((std::uint64_t{1} << count) - 1) : bits;
}

}  // namespace elbowroom::recon
#endif  // HWY_ONCE
