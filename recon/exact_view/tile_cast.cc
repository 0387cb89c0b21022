// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/exact_view/tile_cast.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "core/infinity.h"
#include "recon/exact_view/tile_cast.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kTileRays>;
using Ints = hn::RebindToSigned<Floats>;
using VF = hn::Vec<Floats>;
using VI = hn::Vec<Ints>;
using MF = hn::Mask<Floats>;

using core::kFloatInfinity;

// No fused operation: it would round differently on processors without one.
HWY_INLINE VF At(const CastForm& form, VF u, VF v) {
  const Floats f;
  return hn::Add(hn::Add(hn::Mul(u, hn::Set(f, form.du)), hn::Mul(v, hn::Set(f, form.dv))),
                 hn::Set(f, form.at_origin));
}

// PencilAngle of some rays.
HWY_INLINE VF Angle(const CastPencil& pencil, VF u, VF v) {
  const Floats f;
  const VF x = At(pencil.x, u, v), y = At(pencil.y, u, v);
  const VF share = hn::Div(y, hn::Add(hn::Abs(x), hn::Abs(y)));
  const VF two = hn::IfThenElse(hn::Lt(y, hn::Zero(f)), hn::Set(f, -2.0F), hn::Set(f, 2.0F));
  return hn::IfThenElse(hn::Lt(x, hn::Zero(f)), hn::Sub(two, share), share);
}

// Some rays of the tile.
struct Rays {
  VF u;
  VF v;
};

// How far the rays have come, and the entry that each of them stands at.
struct Front {
  VF key;
  VI camera;
  VI place;  // of the entry, in the camera's crossings
};

HWY_INLINE VI Lanes(MF mask) { return hn::VecFromMask(Ints(), hn::RebindMask(Ints(), mask)); }
HWY_INLINE MF MaskOf(VI lanes) { return hn::RebindMask(Floats(), hn::Lt(lanes, hn::Zero(Ints()))); }

// The lower and the upper halves of some words.
struct Halves {
  VI lower;
  VI upper;
};

HWY_INLINE Halves GatherWords(const std::uint64_t* words, VI at) {
  const Ints n;
#if HWY_TARGET == HWY_SCALAR
  const std::uint64_t word = words[hn::GetLane(at)];
  return {hn::Set(n, static_cast<std::int32_t>(word)), hn::Set(n, static_cast<std::int32_t>(word >> 32U))};
#else
  const hn::Half<Ints> half;
  const hn::RepartitionToWide<Ints> wide;
  const hn::RebindToUnsigned<decltype(wide)> word;
  const auto gather = [&](auto where) {
    return hn::BitCast(n, hn::GatherIndex(word, words, hn::PromoteTo(wide, where)));
  };
  const VI first = gather(hn::LowerHalf(half, at)), second = gather(hn::UpperHalf(half, at));
  return {hn::ConcatEven(n, second, first), hn::ConcatOdd(n, second, first)};
#endif
}

// A mask of the lowest bits, one for each ray of the vector.
HWY_INLINE MF MaskOfBits(std::uint32_t bits) {
  const Ints n;
  const VI one = hn::Set(n, 1);
  const VI shifted = hn::And(hn::Set(n, static_cast<std::int32_t>(bits)), hn::Shl(one, hn::Iota(n, 0)));
  return hn::RebindMask(Floats(), hn::Ne(shifted, hn::Zero(n)));
}

HWY_INLINE void MoveOn(MF which, VF key, std::size_t camera, VI place, Front* front) {
  const Ints n;
  const auto which_n = hn::RebindMask(n, which);
  front->key = hn::IfThenElse(which, key, front->key);
  front->camera = hn::IfThenElse(which_n, hn::Set(n, static_cast<std::int32_t>(camera)), front->camera);
  front->place = hn::IfThenElse(which_n, place, front->place);
}

// One camera's next crossing with each ray, and the camera's label up to there. Entries and exits come in
// turn, so passing a crossing flips the label: a crossing needn't hold which of the two it is.
struct Course {
  VF key;
  VI place;
  MF is_inside;
};

// Takes some rays to their first points in the hull. Invariant: before `front` no point of the ray is in the
// hull, because every move of the front skips a stretch that one camera calls background. The front rests
// when all cameras in a row say object there, which makes it the first point of the hull. Keys only grow, and
// each ray has finitely many crossings, so the walk ends.
class Walk {
 public:
  Walk(const Rays& rays, std::span<const TileCamera> cameras, std::span<const TileCamera> visibility_outlines,
       std::size_t first, TileScratch* scratch)
      : rays_(rays),
        cameras_(cameras),
        visibility_outlines_(visibility_outlines),
        first_(first),
        scratch_(*scratch) {}

  Front Run(VF key_from, VF key_to) {
    const Floats f;
    const Ints n;
    Front front{key_from, hn::Set(n, TileHits::kNoCamera), hn::Zero(n)};
    MF alive = hn::Le(key_from, key_to);
    if (hn::AllFalse(f, alive)) return {hn::Set(f, kFloatInfinity), front.camera, front.place};
    // `agreed`: how many cameras in a row have said object at the front, for all rays that are still alive. A
    // camera that moves some rays agrees with where it moved them to, hence 1 and not 0.
    const std::size_t cameras = cameras_.size();
    for (std::size_t asked = 0, agreed = 0; agreed < cameras; ++asked) {
      const std::size_t i = asked % cameras;
      const Course course = CourseTo(cameras_[i], asked < cameras, alive, front.key, &scratch_.courses[i]);
      const MF outside = hn::AndNot(course.is_inside, alive);
      ++agreed;
      if (!hn::AllFalse(f, outside)) {
        MoveOn(outside, course.key, i, course.place, &front);
        alive = hn::And(alive, hn::Le(front.key, key_to));
        if (hn::AllFalse(f, alive)) break;
        agreed = 1;
      }
      if (agreed == cameras && !visibility_outlines_.empty() && MoveIntoView(alive, &front)) {
        alive = hn::And(alive, hn::Le(front.key, key_to));
        if (hn::AllFalse(f, alive)) break;
        agreed = 0;
      }
    }
    front.key = hn::IfThenElse(alive, front.key, hn::Set(f, kFloatInfinity));
    return front;
  }

  // For each ray of a front the edge that it is on: a number in CastPencil::edges of the camera that moved it
  // there.
  [[nodiscard]] VI EdgesOf(const Front& front) const {
    const Ints n;
    VI found = hn::Zero(n);
    for (std::size_t i = 0; i < cameras_.size() + visibility_outlines_.size(); ++i) {
      const auto is_by = hn::Eq(front.camera, hn::Set(n, static_cast<std::int32_t>(i)));
      const TileCamera& camera =
          i < cameras_.size() ? cameras_[i] : visibility_outlines_[i - cameras_.size()];
      if (hn::AllFalse(n, is_by) || camera.pencil->bins() == 0) continue;
      const std::uint64_t* words = CastCrossing::Words(camera.pencil->intervals.crossings.data());
      const VI place = hn::IfThenElseZero(is_by, front.place);
      found = hn::IfThenElse(is_by, GatherWords(words + 1, hn::Add(place, place)).upper, found);
    }
    return found;
  }

 private:
  // Each ray's list of crossings, with none of them passed yet.
  [[nodiscard]] HWY_INLINE Course Start(const TileCamera& camera) const {
    const Floats f;
    const Ints n;
    const CastPencil& pencil = *camera.pencil;
    const MF is_inside = MaskOfBits(camera.starts_inside >> first_);
    if (pencil.bins() == 0) return {hn::Set(f, kFloatInfinity), hn::Zero(n), is_inside};
    const VF angle = Angle(pencil, rays_.u, rays_.v);
    const MF has_angle = hn::Eq(angle, angle);  // a ray along the pencil's axis has none, and meets no edge
    const VF bin = hn::Mul(hn::Sub(angle, hn::Set(f, pencil.least_angle)), hn::Set(f, pencil.bins_per_angle));
    const VF last_bin = hn::Set(f, static_cast<float>(pencil.bins() - 1));
    const VF in_range = hn::Min(hn::Max(hn::IfThenElseZero(has_angle, bin), hn::Zero(f)), last_bin);
    const VI interval = IntervalsAt(pencil.intervals, hn::ConvertTo(n, in_range), angle);
    const VI first = hn::GatherIndex(n, pencil.intervals.firsts.data(), interval);
    Course course{hn::Zero(f), hn::IfThenElseZero(hn::RebindMask(n, has_angle), first), is_inside};
    Fetch(pencil, &course);
    return course;
  }

  // The bin gives the first interval that an angle can be in; an angle beyond where the next one begins is
  // moved on. Masks are -1 where true, so subtracting one counts up. The loop runs only where a bin has more
  // than two intervals.
  [[nodiscard]] static HWY_INLINE VI IntervalsAt(const CastIntervals& intervals, VI bin, VF angle) {
    const Floats f;
    const Ints n;
    const Halves word = GatherWords(intervals.bins.data(), bin);
    const MF has_more = MaskOf(word.lower);
    VI interval = hn::And(word.lower, hn::Set(n, 0x7FFFFFFF));
    MF is_later = hn::Ge(angle, hn::BitCast(f, word.upper));
    interval = hn::Sub(interval, Lanes(is_later));
    for (is_later = hn::And(is_later, has_more); !hn::AllFalse(f, is_later);) {
      is_later = hn::And(is_later, hn::Ge(angle, hn::GatherIndex(f, intervals.begins.data() + 1, interval)));
      interval = hn::Sub(interval, Lanes(is_later));
    }
    return interval;
  }

  // The key at course->place; behind the last crossing it is infinite.
  HWY_INLINE void Fetch(const CastPencil& pencil, Course* course) const {
    const Floats f;
    const std::uint64_t* words = CastCrossing::Words(pencil.intervals.crossings.data());
    const VI at = hn::Add(course->place, course->place);
    const Halves slopes = GatherWords(words, at), rest = GatherWords(words + 1, at);
    const VF du = hn::BitCast(f, slopes.lower), dv = hn::BitCast(f, slopes.upper);
    // No fused operation, as in At.
    course->key = hn::Add(hn::Add(hn::Mul(rays_.u, du), hn::Mul(rays_.v, dv)), hn::BitCast(f, rest.lower));
  }

  // Passes all crossings up to `at`. Then the course's label is the camera's label at `at`, and its key is
  // the camera's next entry wherever that label is background.
  Course CourseTo(const TileCamera& camera, bool is_first, MF alive, VF at, TileScratch::Course* kept) {
    const Floats f;
    const Ints n;
    Course course = is_first ? Start(camera) : Load(*kept);
    std::int64_t met = is_first ? static_cast<std::int64_t>(hn::CountTrue(f, alive)) : 0;
    for (;;) {
      const MF passes = hn::And(alive, hn::Le(course.key, at));
      if (hn::AllFalse(f, passes)) break;
      met += static_cast<std::int64_t>(hn::CountTrue(f, passes));
      course.is_inside = hn::Xor(course.is_inside, passes);
      course.place = hn::Sub(course.place, Lanes(passes));
      Fetch(*camera.pencil, &course);
    }
    scratch_.crossings_met += met;
    hn::Store(course.key, f, kept->key);
    hn::Store(course.place, n, kept->place);
    hn::Store(Lanes(course.is_inside), n, kept->is_inside);
    return course;
  }

  [[nodiscard]] static Course Load(const TileScratch::Course& kept) {
    const Floats f;
    const Ints n;
    return {hn::Load(f, kept.key), hn::Load(n, kept.place), MaskOf(hn::Load(n, kept.is_inside))};
  }

  // Rays whose front is outside of every outline move on to the nearest entry of one. False: none had to.
  bool MoveIntoView(MF alive, Front* front) {
    const Floats f;
    MF unseen = alive;
    Front nearest{hn::Set(f, kFloatInfinity), front->camera, front->place};
    for (std::size_t i = 0; i < visibility_outlines_.size(); ++i) {
      const std::size_t number = cameras_.size() + i;
      const Course course =
          CourseTo(visibility_outlines_[i], !has_visibility_, alive, front->key, &scratch_.courses[number]);
      unseen = hn::AndNot(course.is_inside, unseen);
      MoveOn(hn::Lt(course.key, nearest.key), course.key, number, course.place, &nearest);
    }
    has_visibility_ = true;
    if (hn::AllFalse(f, unseen)) return false;
    const auto unseen_n = hn::RebindMask(Ints(), unseen);
    front->key = hn::IfThenElse(unseen, nearest.key, front->key);
    front->camera = hn::IfThenElse(unseen_n, nearest.camera, front->camera);
    front->place = hn::IfThenElse(unseen_n, nearest.place, front->place);
    return true;
  }

  const Rays& rays_;
  std::span<const TileCamera> cameras_;
  std::span<const TileCamera> visibility_outlines_;
  std::size_t first_;
  TileScratch& scratch_;
  bool has_visibility_ = false;  // the outlines' courses have begun
};

// The workspace's share of each ray: the intersection of half-spaces, each a bound that is affine in (u, v).
HWY_INLINE void Clip(const CastBox& box, const Rays& rays, VF* key_from, VF* key_to) {
  const Floats f;
  MF is_beside = hn::Ne(rays.u, rays.u);  // no ray
  for (const CastForm& form : box.not_before) *key_from = hn::Max(*key_from, At(form, rays.u, rays.v));
  for (const CastForm& form : box.not_after) *key_to = hn::Min(*key_to, At(form, rays.u, rays.v));
  for (const CastForm& form : box.beside)
    is_beside = hn::Or(is_beside, hn::Lt(At(form, rays.u, rays.v), hn::Zero(f)));
  *key_to = hn::IfThenElse(is_beside, hn::Set(f, -kFloatInfinity), *key_to);
  *key_from = hn::IfThenElse(is_beside, hn::Set(f, kFloatInfinity), *key_from);
}

void Cast(const TileRays& tile, const CastBox& box, std::span<const TileCamera> cameras,
          std::span<const TileCamera> visibility_outlines, bool wants_edges, TileScratch* scratch,
          TileHits* hits) {
  const Floats f;
  scratch->courses.resize(cameras.size() + visibility_outlines.size());
  hits->count = 0;
  using Limits = std::numeric_limits<float>;
  const float last_key = tile.is_perspective ? -Limits::denorm_min() : Limits::max();
  for (std::size_t first = 0; first < kTileRays; first += hn::Lanes(f)) {
    const Rays rays{hn::Load(f, tile.u + first), hn::Load(f, tile.v + first)};
    VF key_from = hn::Set(f, -kFloatInfinity), key_to = hn::Set(f, last_key);
    Clip(box, rays, &key_from, &key_to);
    Walk walk(rays, cameras, visibility_outlines, first, scratch);
    const Front front = walk.Run(key_from, key_to);
    const MF is_hit = hn::Lt(hn::Abs(front.key), hn::Set(f, kFloatInfinity));
    const VF depth_mm = tile.is_perspective ? hn::Div(hn::Set(f, -1.0F), front.key) : front.key;
    hn::Store(hn::IfThenElseZero(is_hit, depth_mm), f, hits->depth_mm + first);
    const std::size_t count = hn::CountTrue(f, is_hit);
    hits->count += static_cast<int>(count);
    const VI miss = hn::Set(Ints(), TileHits::kMiss);
    hn::Store(hn::IfThenElse(hn::RebindMask(Ints(), is_hit), front.camera, miss), Ints(),
              hits->camera + first);
    if (wants_edges && count > 0) hn::Store(walk.EdgesOf(front), Ints(), hits->edge + first);
  }
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(Cast);

void CastTile(const TileRays& rays, const CastBox& box, std::span<const TileCamera> cameras,
              std::span<const TileCamera> visibility_outlines, bool wants_edges, TileScratch* scratch,
              TileHits* hits) {
  HWY_DYNAMIC_DISPATCH(Cast)(rays, box, cameras, visibility_outlines, wants_edges, scratch, hits);
}

}  // namespace elbowroom::recon
#endif
