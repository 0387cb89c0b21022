#include "recon/paper_methods/plane_sweep_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/paper_methods/plane_sweep_kernel.cc"
// In this order: the first includes this file once for each kind of processor.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kSweepTilePx>;
using Float = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;
using Ints = hn::RebindToSigned<Floats>;

constexpr Floats kFloats;

struct Position {
  Float x, y;
};

Float At(float value) { return hn::Set(kFloats, value); }

struct Points {
  Float x, y, z;
};

// origin + dx * along_x + dy * along_y.
Points PointsAt(const SweepPoints& points, Float dx, Float dy) {
  const auto axis = [&](std::size_t i) {
    return hn::MulAdd(dx, At(points.along_x[i]), hn::MulAdd(dy, At(points.along_y[i]), At(points.origin[i])));
  };
  return {axis(0), axis(1), axis(2)};
}

// core::Lens::Distort.
template <SweepLens kLens>
Position Distort(const SweepAsker& asker, Float x, Float y, Float r2) {
  if constexpr (kLens == SweepLens::kIdeal) return {x, y};
  const Float one = At(1.0F);
  const auto& k = asker.coefficients.radial;
  if constexpr (kLens == SweepLens::kFisheye) {
    const Float r = hn::Sqrt(r2);
    const Float theta = hn::Atan(kFloats, r), t2 = hn::Mul(theta, theta);
    const Float series = hn::MulAdd(
        t2, hn::MulAdd(t2, hn::MulAdd(t2, hn::MulAdd(t2, At(k[3]), At(k[2])), At(k[1])), At(k[0])), one);
    const Float scale = hn::IfThenElse(hn::Gt(r2, At(1e-12F)), hn::Div(hn::Mul(theta, series), r), one);
    return {hn::Mul(x, scale), hn::Mul(y, scale)};
  }
  const auto series = [&](std::size_t i) {
    return hn::MulAdd(r2, hn::MulAdd(r2, hn::MulAdd(r2, At(k[i + 2]), At(k[i + 1])), At(k[i])), one);
  };
  const Float scale = hn::Div(series(0), series(3));
  const Float p1 = At(asker.coefficients.tangential[0]), p2 = At(asker.coefficients.tangential[1]);
  const Float xy2 = hn::Mul(hn::Add(x, x), y), x2 = hn::Mul(x, x), y2 = hn::Mul(y, y);
  const Float off_x =
      hn::MulAdd(r2, hn::MulAdd(r2, At(asker.coefficients.prism[1]), At(asker.coefficients.prism[0])),
                 hn::MulAdd(p1, xy2, hn::Mul(p2, hn::Add(r2, hn::Add(x2, x2)))));
  const Float off_y =
      hn::MulAdd(r2, hn::MulAdd(r2, At(asker.coefficients.prism[3]), At(asker.coefficients.prism[2])),
                 hn::MulAdd(p2, xy2, hn::Mul(p1, hn::Add(r2, hn::Add(y2, y2)))));
  return {hn::MulAdd(x, scale, off_x), hn::MulAdd(y, scale, off_y)};
}

Mask IsWithin(const Position& p, const std::array<float, 2>& min, const std::array<float, 2>& max) {
  return hn::And(hn::And(hn::Ge(p.x, At(min[0])), hn::Lt(p.x, At(max[0]))),
                 hn::And(hn::Ge(p.y, At(min[1])), hn::Lt(p.y, At(max[1]))));
}

// Bilinear coverage of at least one half; lanes outside `valid` are looked up at the first texel.
Mask IsCovered(const SweepAsker& asker, const Position& p, Mask valid) {
  constexpr Ints kInts;
  const Float x = hn::IfThenElseZero(valid, p.x), y = hn::IfThenElseZero(valid, p.y);
  const Float column = hn::Floor(x), row = hn::Floor(y), u = hn::Sub(x, column), v = hn::Sub(y, row);
  const auto stride = hn::Set(kInts, asker.stride);
  const auto upper = hn::Add(hn::Mul(hn::ConvertTo(kInts, row), stride), hn::ConvertTo(kInts, column));
  // Four bytes at once: two of them are neighbours in a row.
  const auto* words = reinterpret_cast<const std::int32_t*>(asker.texels);
  const auto above = hn::GatherOffset(kInts, words, upper);
  const auto below = hn::GatherOffset(kInts, words, hn::Add(upper, stride));
  const auto byte = hn::Set(kInts, 0xFF);
  const auto lerp_row = [&](auto texels) {
    const Float left = hn::ConvertTo(kFloats, hn::And(texels, byte));
    const Float right = hn::ConvertTo(kFloats, hn::And(hn::ShiftRight<8>(texels), byte));
    return hn::MulAdd(u, hn::Sub(right, left), left);
  };
  const Float top = lerp_row(above);
  return hn::Ge(hn::MulAdd(v, hn::Sub(lerp_row(below), top), top), At(static_cast<float>(kObjectLevel)));
}

template <SweepLens kLens>
bool AskAs(const SweepTile& tile, const SweepAsker& asker, SweepMarks* marks) {
  const Float zero = hn::Zero(kFloats);
  bool any_open = false;
  for (std::size_t i = 0; i < kSweepTilePixels; i += hn::Lanes(kFloats)) {
    const Float open = hn::Load(kFloats, marks->open.data() + i);
    if (hn::AllFalse(kFloats, hn::Gt(open, zero))) continue;
    const Points point =
        PointsAt(asker.points, hn::Load(kFloats, tile.dx.data() + i), hn::Load(kFloats, tile.dy.data() + i));
    const Float x = hn::Div(point.x, point.z), y = hn::Div(point.y, point.z);
    const Float r2 = hn::MulAdd(x, x, hn::Mul(y, y));
    const Mask in_domain = hn::And(hn::Gt(point.z, zero), hn::Le(r2, At(asker.max_radius_squared)));
    const Position distorted = Distort<kLens>(asker, x, y, r2);
    const Position pixel{
        hn::MulAdd(distorted.x, At(asker.fx), hn::MulAdd(distorted.y, At(asker.skew), At(asker.cx))),
        hn::MulAdd(distorted.y, At(asker.fy), At(asker.cy))};
    const Mask valid = hn::And(in_domain, IsWithin(pixel, asker.valid_min, asker.valid_max));
    Mask is_object = valid;
    if (!hn::AllFalse(kFloats, valid)) is_object = hn::And(valid, IsCovered(asker, pixel, valid));
    if (asker.exterior_is_object) {
      const Mask is_seen = hn::And(in_domain, IsWithin(pixel, asker.picture_min, asker.picture_max));
      is_object = hn::Or(is_object, hn::Not(is_seen));
      const Float seen = hn::Load(kFloats, marks->seen.data() + i);
      hn::Store(hn::IfThenElse(is_seen, At(1.0F), seen), kFloats, marks->seen.data() + i);
    }
    const Float left = hn::IfThenElseZero(is_object, open);
    hn::Store(left, kFloats, marks->open.data() + i);
    any_open |= !hn::AllFalse(kFloats, hn::Gt(left, zero));
  }
  return any_open;
}

bool AskCamera(const SweepTile& tile, const SweepAsker& asker, SweepMarks* marks) {
  switch (asker.lens) {
    case SweepLens::kIdeal:
      return AskAs<SweepLens::kIdeal>(tile, asker, marks);
    case SweepLens::kPolynomial:
      return AskAs<SweepLens::kPolynomial>(tile, asker, marks);
    case SweepLens::kFisheye:
      break;
  }
  return AskAs<SweepLens::kFisheye>(tile, asker, marks);
}

bool AskBox(const SweepTile& tile, const SweepBox& box, SweepMarks* marks) {
  bool any_open = false;
  for (std::size_t i = 0; i < kSweepTilePixels; i += hn::Lanes(kFloats)) {
    const Points point =
        PointsAt(box.points, hn::Load(kFloats, tile.dx.data() + i), hn::Load(kFloats, tile.dy.data() + i));
    const auto within = [&](Float value, std::size_t axis) {
      return hn::And(hn::Ge(value, At(box.min[axis])), hn::Le(value, At(box.max[axis])));
    };
    const Mask inside = hn::And(within(point.x, 0), hn::And(within(point.y, 1), within(point.z, 2)));
    const Float left = hn::IfThenElseZero(inside, hn::Load(kFloats, marks->open.data() + i));
    hn::Store(left, kFloats, marks->open.data() + i);
    any_open |= !hn::AllFalse(kFloats, hn::Gt(left, hn::Zero(kFloats)));
  }
  return any_open;
}

}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(AskCamera);
HWY_EXPORT(AskBox);

bool AskSweepCamera(const SweepTile& tile, const SweepAsker& asker, SweepMarks* marks) {
  return HWY_DYNAMIC_DISPATCH(AskCamera)(tile, asker, marks);
}

bool AskSweepBox(const SweepTile& tile, const SweepBox& box, SweepMarks* marks) {
  return HWY_DYNAMIC_DISPATCH(AskBox)(tile, box, marks);
}

}  // namespace elbowroom::recon
#endif
