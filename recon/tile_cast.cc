// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/tile_cast.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "recon/tile_cast.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kTileRays>;
using Ints = hn::RebindToSigned<Floats>;
using VF = hn::Vec<Floats>;
using VI = hn::Vec<Ints>;
using MF = hn::Mask<Floats>;
using Kept = TileScratch::Kept;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

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
  VF key_end;
};

// Where rays are now, and whose entry brought them there.
struct Front {
  VF key;
  VI camera;
};

// One camera's crossings with rays about a key: the last entry and the last exit up to it, the first entry
// beyond.
struct About {
  VF last_entry;
  VF last_exit;
  VF next_entry;
};

HWY_INLINE About NothingAbout() {
  const Floats f;
  return {hn::Set(f, -kInfinity), hn::Set(f, -kInfinity), hn::Set(f, kInfinity)};
}

HWY_INLINE void AddEntry(VF key, VF at, About* about) {
  const MF is_past = hn::Le(key, at);
  about->last_entry = hn::IfThenElse(is_past, hn::Max(about->last_entry, key), about->last_entry);
  about->next_entry = hn::IfThenElse(is_past, about->next_entry, hn::Min(about->next_entry, key));
}

HWY_INLINE void AddExit(VF key, VF at, About* about) {
  about->last_exit = hn::IfThenElse(hn::Le(key, at), hn::Max(about->last_exit, key), about->last_exit);
}

// The bits of the vector's rays.
HWY_INLINE MF MaskOf(std::uint32_t bits) {
  const Floats f;
  if (bits == 0) return hn::Gt(hn::Zero(f), hn::Zero(f));
  alignas(64) float lanes[kTileRays];
  for (std::size_t i = 0; i < hn::Lanes(f); ++i) lanes[i] = ((bits >> i) & 1U) != 0 ? 1.0F : 0.0F;
  return hn::Gt(hn::Load(f, lanes), hn::Zero(f));
}

// By the last crossing, or else the label that the ray came with.
HWY_INLINE MF IsInside(const About& about, std::uint32_t starts_inside) {
  const Floats f;
  const MF by_crossing = hn::Gt(about.last_entry, about.last_exit);
  if (starts_inside == 0) return by_crossing;
  const MF none = hn::Eq(hn::Max(about.last_entry, about.last_exit), hn::Set(f, -kInfinity));
  return hn::Or(by_crossing, hn::And(none, MaskOf(starts_inside)));
}

HWY_INLINE void MoveOn(MF which, VF key, std::size_t camera, Front* front) {
  const Ints n;
  front->key = hn::IfThenElse(which, key, front->key);
  front->camera =
      hn::IfThenElse(hn::RebindMask(n, which), hn::Set(n, static_cast<std::int32_t>(camera)), front->camera);
}

// The walk of some rays, from camera to camera, until all agree.
class Walk {
 public:
  Walk(const Rays& rays, std::span<const TileCamera> cameras, std::span<const TileCamera> sights,
       std::size_t first, TileScratch* scratch)
      : rays_(rays), cameras_(cameras), sights_(sights), first_(first), scratch_(*scratch) {}

  Front Run(VF key_from, VF key_to) {
    const Floats f;
    Front front{key_from, hn::Set(Ints(), TileHits::kNoCamera)};
    MF alive = hn::Le(key_from, key_to);
    if (hn::AllFalse(f, alive)) return {hn::Set(f, kInfinity), front.camera};
    // Until as many in a row agree as there are cameras.
    const std::size_t cameras = cameras_.size();
    for (std::size_t asked = 0, agreed = 0; agreed < cameras; ++asked) {
      const std::size_t i = asked % cameras;
      const About about = asked < cameras ? CrossFirst(cameras_[i], alive, front.key, &scratch_.kept[i])
                                          : CrossAgain(cameras_[i], alive, front.key, &scratch_.kept[i]);
      const MF outside = hn::AndNot(IsInside(about, cameras_[i].starts_inside >> first_), alive);
      ++agreed;
      if (!hn::AllFalse(f, outside)) {
        MoveOn(outside, about.next_entry, i, &front);
        alive = hn::And(alive, hn::Le(front.key, key_to));
        if (hn::AllFalse(f, alive)) break;
        agreed = 1;
      }
      if (agreed == cameras && !sights_.empty() && MoveIntoSight(alive, &front)) {
        alive = hn::And(alive, hn::Le(front.key, key_to));
        if (hn::AllFalse(f, alive)) break;
        agreed = 0;
      }
    }
    front.key = hn::IfThenElse(alive, front.key, hn::Set(f, kInfinity));
    return front;
  }

  // The edges that the rays of a front are on, of the cameras that brought them there.
  VI EdgesOf(const Front& front) {
    const Floats f;
    const Ints n;
    VI found = hn::Zero(n);
    for (std::size_t i = 0; i < cameras_.size() + sights_.size(); ++i) {
      const MF is_by = hn::RebindMask(f, hn::Eq(front.camera, hn::Set(n, static_cast<std::int32_t>(i))));
      const TileCamera& camera = i < cameras_.size() ? cameras_[i] : sights_[i - cameras_.size()];
      if (hn::AllFalse(f, is_by) || camera.pencil->bins == 0) continue;
      Kept bins;
      const VF angle = Angle(*camera.pencil, rays_.u, rays_.v);
      FindBins(*camera.pencil, is_by, angle, &bins);
      Cross(camera.pencil->entries, bins, angle, [&](const CastEdge& edge, VF key) {
        const MF is_edge = hn::And(is_by, hn::Eq(key, front.key));
        found = hn::IfThenElse(hn::RebindMask(n, is_edge), hn::Set(n, static_cast<std::int32_t>(edge.edge)),
                               found);
      });
    }
    return found;
  }

 private:
  // Calls visit(edge, key) for the edges of the bins that some ray crosses; key is infinite for the rays that
  // don't.
  template <typename Visit>
  HWY_INLINE void Cross(const CastEdges& edges, const Kept& bins, VF angle, const Visit& visit) {
    const Floats f;
    const auto cross = [&](const CastEdge& edge) {
      const MF crosses = hn::And(hn::Ge(angle, hn::Set(f, edge.from)), hn::Lt(angle, hn::Set(f, edge.to)));
      if (hn::AllFalse(f, crosses)) return;
      const VF key = At(edge.key, rays_.u, rays_.v);
      const MF is_ahead = hn::And(crosses, hn::Lt(key, rays_.key_end));
      visit(edge, hn::IfThenElse(is_ahead, key, hn::Set(f, kInfinity)));
    };
    const std::uint32_t begin = edges.first[bins.first_bin], end = edges.first[bins.last_bin + 1];
    for (std::uint32_t i = begin; i < end; ++i) cross(edges.edges[i]);
    const std::uint32_t carried_begin = edges.first_carried[bins.first_bin];
    const std::uint32_t carried_end = edges.first_carried[bins.first_bin + 1];
    for (std::uint32_t i = carried_begin; i < carried_end; ++i) cross(edges.edges[edges.carried[i]]);
    scratch_.edges_met += end - begin + carried_end - carried_begin;
  }

  // Room for the keys of the edges of some bins.
  void Reserve(const CastEdges& edges, const Kept& bins) {
    const std::size_t count = edges.first[bins.last_bin + 1] - edges.first[bins.first_bin] +
                              edges.first_carried[bins.first_bin + 1] - edges.first_carried[bins.first_bin];
    const std::size_t needed = keys_ + count * hn::Lanes(Floats());
    if (scratch_.keys.size() < needed) scratch_.keys.resize(2 * needed);
  }
  HWY_INLINE void Store(VF key) {
    hn::StoreU(key, Floats(), scratch_.keys.data() + keys_);
    keys_ += hn::Lanes(Floats());
  }

  // The bins of the living rays' angles.
  static void FindBins(const CastPencil& pencil, MF alive, VF angle, Kept* kept) {
    const Floats f;
    const float least = hn::GetLane(hn::MinOfLanes(f, hn::IfThenElse(alive, angle, hn::Set(f, 2.0F))));
    const float most = hn::GetLane(hn::MaxOfLanes(f, hn::IfThenElse(alive, angle, hn::Set(f, -2.0F))));
    const auto last = static_cast<float>(pencil.bins - 1);
    // Rays on both sides of the negative x axis, or a ray along the pencil's own: all bins.
    const bool is_anywhere = !(most - least <= 2.0F);
    const float first_bin = (least - pencil.least_angle) * pencil.bins_per_angle;
    const float last_bin = (most - pencil.least_angle) * pencil.bins_per_angle;
    kept->first_bin = is_anywhere ? 0 : static_cast<std::uint32_t>(std::clamp(first_bin, 0.0F, last));
    kept->last_bin =
        is_anywhere ? pencil.bins - 1 : static_cast<std::uint32_t>(std::clamp(last_bin, 0.0F, last));
  }

  // Works out one camera's crossings, and says what they are about `at`.
  About CrossFirst(const TileCamera& camera, MF alive, VF at, Kept* kept) {
    About about = NothingAbout();
    *kept = {};
    kept->entry_keys = keys_;
    if (camera.pencil->bins == 0) {
      kept->has_exits = true;
      return about;
    }
    const VF angle = Angle(*camera.pencil, rays_.u, rays_.v);
    FindBins(*camera.pencil, alive, angle, kept);
    Reserve(camera.pencil->entries, *kept);
    Cross(camera.pencil->entries, *kept, angle, [&](const CastEdge&, VF key) {
      Store(key);
      ++kept->entries;
      AddEntry(key, at, &about);
    });
    AddExits(camera, alive, at, kept, &about);
    return about;
  }

  // The same again about another key.
  About CrossAgain(const TileCamera& camera, MF alive, VF at, Kept* kept) {
    const Floats f;
    About about = NothingAbout();
    const float* keys = scratch_.keys.data() + kept->entry_keys;
    for (std::size_t i = 0; i < kept->entries; ++i, keys += hn::Lanes(f))
      AddEntry(hn::LoadU(f, keys), at, &about);
    AddExits(camera, alive, at, kept, &about);
    return about;
  }

  // Exits matter only to rays that are, or may be, inside.
  void AddExits(const TileCamera& camera, MF alive, VF at, Kept* kept, About* about) {
    const Floats f;
    const MF has_entered = hn::And(alive, hn::Gt(about->last_entry, hn::Set(f, -kInfinity)));
    if (camera.starts_inside == 0 && hn::AllFalse(f, has_entered)) return;
    if (!kept->has_exits) {
      kept->has_exits = true;
      kept->exit_keys = keys_;
      Reserve(camera.pencil->exits, *kept);
      Cross(camera.pencil->exits, *kept, Angle(*camera.pencil, rays_.u, rays_.v),
            [&](const CastEdge&, VF key) {
              Store(key);
              ++kept->exits;
            });
    }
    const float* keys = scratch_.keys.data() + kept->exit_keys;
    for (std::size_t i = 0; i < kept->exits; ++i, keys += hn::Lanes(f))
      AddExit(hn::LoadU(f, keys), at, about);
  }

  // Rays that no camera sees go on to where one does. Rare enough to work all crossings out anew.
  bool MoveIntoSight(MF alive, Front* front) {
    const Floats f;
    const VF at = front->key;
    MF unseen = alive;
    Front nearest{hn::Set(f, kInfinity), front->camera};
    for (std::size_t i = 0; i < sights_.size(); ++i) {
      Kept kept;
      const About about = CrossFirst(sights_[i], alive, at, &kept);
      unseen = hn::AndNot(IsInside(about, sights_[i].starts_inside >> first_), unseen);
      MoveOn(hn::Lt(about.next_entry, nearest.key), about.next_entry, cameras_.size() + i, &nearest);
    }
    if (hn::AllFalse(f, unseen)) return false;
    front->key = hn::IfThenElse(unseen, nearest.key, front->key);
    front->camera = hn::IfThenElse(hn::RebindMask(Ints(), unseen), nearest.camera, front->camera);
    return true;
  }

  const Rays& rays_;
  std::span<const TileCamera> cameras_;
  std::span<const TileCamera> sights_;
  std::size_t first_;
  TileScratch& scratch_;
  std::size_t keys_ = 0;  // in use
};

HWY_INLINE void Clip(const CastBox& box, const Rays& rays, VF* key_from, VF* key_to) {
  const Floats f;
  MF is_beside = hn::Ne(rays.u, rays.u);  // no ray
  for (const CastForm& form : box.not_before) *key_from = hn::Max(*key_from, At(form, rays.u, rays.v));
  for (const CastForm& form : box.not_after) *key_to = hn::Min(*key_to, At(form, rays.u, rays.v));
  for (const CastForm& form : box.beside)
    is_beside = hn::Or(is_beside, hn::Lt(At(form, rays.u, rays.v), hn::Zero(f)));
  *key_to = hn::IfThenElse(is_beside, hn::Set(f, -kInfinity), *key_to);
  *key_from = hn::IfThenElse(is_beside, hn::Set(f, kInfinity), *key_from);
}

void Cast(const TileRays& tile, const CastBox& box, std::span<const TileCamera> cameras,
          std::span<const TileCamera> sights, bool wants_edges, TileScratch* scratch, TileHits* hits) {
  const Floats f;
  scratch->kept.resize(cameras.size());
  hits->any = false;
  for (std::size_t first = 0; first < kTileRays; first += hn::Lanes(f)) {
    const Rays rays{hn::Load(f, tile.u + first), hn::Load(f, tile.v + first), hn::Set(f, tile.key_end)};
    VF key_from = hn::Set(f, -kInfinity), key_to = rays.key_end;
    Clip(box, rays, &key_from, &key_to);
    Walk walk(rays, cameras, sights, first, scratch);
    const Front front = walk.Run(key_from, key_to);
    hn::Store(front.key, f, hits->key + first);
    if (hn::AllTrue(f, hn::Eq(front.key, hn::Set(f, kInfinity)))) continue;
    hits->any = true;
    hn::Store(front.camera, Ints(), hits->camera + first);
    if (wants_edges) hn::Store(walk.EdgesOf(front), Ints(), hits->edge + first);
  }
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(Cast);

void CastTile(const TileRays& rays, const CastBox& box, std::span<const TileCamera> cameras,
              std::span<const TileCamera> sights, bool wants_edges, TileScratch* scratch, TileHits* hits) {
  HWY_DYNAMIC_DISPATCH(Cast)(rays, box, cameras, sights, wants_edges, scratch, hits);
}

}  // namespace elbowroom::recon
#endif
