#include "recon/segmentation/coverage_kernel.h"

#include <algorithm>

// Highway compiles what stands between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE once a target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/segmentation/coverage_kernel.cc"  // NOLINT(bugprone-macro-parentheses)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon {
namespace HWY_NAMESPACE {  // NOLINT(google-build-namespaces)
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, CoverageSamples::kBatch>;
using Ints = hn::Rebind<std::int32_t, Floats>;
using Bits = hn::Rebind<std::uint32_t, Floats>;
using V = hn::Vec<Floats>;

struct Bgr {
  V b, g, r;
};

// No contraction to fused multiply-add, so that every target rounds alike.
HWY_INLINE V Dot(const Bgr& p, const Bgr& q) {
  return hn::Add(hn::Add(hn::Mul(p.b, q.b), hn::Mul(p.g, q.g)), hn::Mul(p.r, q.r));
}
HWY_INLINE Bgr Minus(const Bgr& p, const Bgr& q) {
  return {hn::Sub(p.b, q.b), hn::Sub(p.g, q.g), hn::Sub(p.r, q.r)};
}
HWY_INLINE Bgr Times(V s, const Bgr& p) { return {hn::Mul(s, p.b), hn::Mul(s, p.g), hn::Mul(s, p.r)}; }
HWY_INLINE V Clamped(V v, float low, float high) {
  return hn::Min(hn::Max(v, hn::Set(Floats(), low)), hn::Set(Floats(), high));
}

template <int kBits>
HWY_INLINE Bgr Unpacked(const CoverageSamples::Colors& colors, std::size_t i) {
  const Bits bits;
  const auto packed = hn::Load(bits, colors.data() + i), mask = hn::Set(bits, (1U << kBits) - 1);
  const V unit = hn::Set(Floats(), 256.0F / (1 << kBits));
  const auto levels = [&](hn::Vec<Bits> channel) HWY_ATTR {
    return hn::Mul(unit, hn::ConvertTo(Floats(), hn::BitCast(Ints(), hn::And(channel, mask))));
  };
  return {levels(packed), levels(hn::ShiftRight<kBits>(packed)), levels(hn::ShiftRight<2 * kBits>(packed))};
}
HWY_INLINE Bgr Image(const CoverageSamples::Colors& colors, std::size_t i) { return Unpacked<8>(colors, i); }
HWY_INLINE Bgr Mean(const CoverageSamples::Colors& colors, std::size_t i) { return Unpacked<10>(colors, i); }

// How bright the background is outside the boundary, as a share of its mean: shade of the object, or a change
// of exposure. It is the g that minimises |I - g * mean|^2 over two pixels outwards: sum(I . mean) / sum(mean
// . mean). 1 where no background pixel is at hand.
HWY_INLINE V Light(const CoverageSamples& samples, std::size_t i) {
  constexpr float kDarkest = 0.3F, kBrightest = 1.5F;
  const V one = hn::Set(Floats(), 1.0F), zero = hn::Zero(Floats());
  V im = zero, mm = zero;
  for (const CoverageSamples::Pair& pair : samples.light) {
    const Bgr mean = Mean(pair.mean, i);
    im = hn::Add(im, Dot(Image(pair.image, i), mean)), mm = hn::Add(mm, Dot(mean, mean));
  }
  const auto is_lit = hn::Gt(mm, zero);
  const V share = hn::Div(im, hn::IfThenElse(is_lit, mm, one));
  return hn::IfThenElse(is_lit, Clamped(share, kDarkest, kBrightest), one);
}

// The object's colour less the background's. It is taken as near to the boundary as possible, since shading
// changes towards an object's rim: from the pixel at the rim if that is wholly object, else from the next one
// inwards. A rim pixel that is much weaker than the next one along its direction is a mixture with
// background.
HWY_INLINE Bgr Whole(const CoverageSamples& samples, const Bgr& background, std::size_t i) {
  constexpr float kLeastShare = 0.85F;
  const Bgr near = Minus(Image(samples.near, i), background), far = Minus(Image(samples.far, i), background);
  const auto is_whole = hn::Ge(Dot(near, far), hn::Mul(hn::Set(Floats(), kLeastShare), Dot(far, far)));
  return {hn::IfThenElse(is_whole, near.b, far.b), hn::IfThenElse(is_whole, near.g, far.g),
          hn::IfThenElse(is_whole, near.r, far.r)};
}

// From a distance to a level: 127.5 at the boundary, 0 and 255 a pixel outside and inside of it. Kept to the
// side that `is_object` says, so that rounding can't move a pixel over the boundary.
template <class Mask>
HWY_INLINE hn::Vec<Ints> LevelOf(V inside_px, Mask is_object) {
  const V middle = hn::Set(Floats(), 128.0F), scale = hn::Set(Floats(), 127.5F);
  const V level = hn::Add(middle, hn::Mul(scale, Clamped(inside_px, -1.0F, 0.999F)));
  return hn::ConvertTo(
      Ints(), hn::IfThenElse(is_object, hn::Max(level, middle), hn::Min(level, hn::Set(Floats(), 127.0F))));
}

void Reckon(const CoverageSamples& samples, float least_contrast2, std::size_t count, std::uint32_t* levels) {
  const Floats d;
  const V zero = hn::Zero(d), half = hn::Set(d, 0.5F), one = hn::Set(d, 1.0F);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V light = Light(samples, i);
    const Bgr whole = Whole(samples, Times(light, Mean(samples.here.mean, i)), i);
    const V contrast2 = Dot(whole, whole);
    const auto is_positive = hn::Gt(contrast2, zero);
    const V per_contrast2 = hn::Div(one, hn::IfThenElse(is_positive, contrast2, one));
    // The share of object in a pixel: its difference from the background, projected on that of the whole
    // object.
    const auto alpha_of = [&](const CoverageSamples::Pair& pair) HWY_ATTR {
      const Bgr difference = Minus(Image(pair.image, i), Times(light, Mean(pair.mean, i)));
      return Clamped(hn::Mul(Dot(difference, whole), per_contrast2), 0.0F, 1.0F);
    };
    const V alpha = alpha_of(samples.here);
    const V sum = hn::Add(hn::Add(alpha, alpha_of(samples.before)), alpha_of(samples.after));
    // Across an edge alpha falls from 1 to 0 over three pixels at most, so the sum over pixel and neighbours
    // says where the edge is, however the lens spreads it: 1.5 if it goes through the pixel's centre.
    const V sum_px = hn::Sub(sum, hn::Set(d, 1.5F));
    const auto is_object = hn::Ge(alpha, half);
    // If the pixel says object and the sum doesn't (or the reverse), alpha falls off (or rises) to both
    // sides: a line a pixel wide, half of it on either side of the centre. Its edge follows from the pixel's
    // own share.
    const auto is_line = hn::Xor(is_object, hn::Gt(sum_px, zero));
    const V inside_px = hn::IfThenElse(is_line, hn::Sub(alpha, half), sum_px);
    const auto is_known = hn::And(is_positive, hn::Ge(contrast2, hn::Set(d, least_contrast2)));
    const auto known = hn::IfThenElseZero(hn::RebindMask(Ints(), is_known),
                                          hn::Set(Ints(), static_cast<std::int32_t>(kCoverageKnown)));
    hn::Store(hn::BitCast(Bits(), hn::Or(LevelOf(inside_px, is_object), known)), Bits(), levels + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace elbowroom::recon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {
namespace {

HWY_EXPORT(Reckon);

}  // namespace

void ReckonCoverage(const CoverageSamples& samples, float least_contrast2, std::span<std::uint32_t> levels) {
  alignas(64) std::uint32_t reckoned[CoverageSamples::kBatch];
  HWY_DYNAMIC_DISPATCH(Reckon)(samples, least_contrast2, levels.size(), reckoned);
  std::copy_n(reckoned, levels.size(), levels.begin());
}

}  // namespace elbowroom::recon
#endif  // HWY_ONCE
