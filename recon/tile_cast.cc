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

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// No fused operation: it would round differently on processors without one.
HWY_INLINE VF At(const CastForm& form, VF u, VF v) {
  const Floats f;
  return hn::Add(hn::Add(hn::Mul(u, hn::Set(f, form.du)), hn::Mul(v, hn::Set(f, form.dv))),
                 hn::Set(f, form.at_origin));
}

// Some rays of the tile.
struct Rays {
  VF u;
  VF v;
  VF key_end;
};

// Where rays are now, and what brought them there.
struct Front {
  VF key;
  VI camera;
  VI edge;
};

// One camera's crossings with rays about a key: the last entry and the last exit up to it, the first entry
// beyond.
struct About {
  VF last_entry;
  VF last_exit;
  VF next_entry;
  VI next_edge;
};

HWY_INLINE About NothingAbout() {
  const Floats f;
  return {hn::Set(f, -kInfinity), hn::Set(f, -kInfinity), hn::Set(f, kInfinity), hn::Zero(Ints())};
}

HWY_INLINE VF LastOf(VF last, VF key, VF at) {
  return hn::IfThenElse(hn::And(hn::Le(key, at), hn::Gt(key, last)), key, last);
}

HWY_INLINE void AddEntry(VF key, VF at, std::uint32_t edge, About* about) {
  about->last_entry = LastOf(about->last_entry, key, at);
  const MF is_next = hn::And(hn::Gt(key, at), hn::Lt(key, about->next_entry));
  about->next_entry = hn::IfThenElse(is_next, key, about->next_entry);
  about->next_edge = hn::IfThenElse(hn::RebindMask(Ints(), is_next),
                                    hn::Set(Ints(), static_cast<std::int32_t>(edge)), about->next_edge);
}

// The rays that pass between an edge's ends on the way that its kind asks for.
template <bool kEnters>
HWY_INLINE MF Crosses(const CastEdge& edge, const Rays& rays) {
  const VF zero = hn::Zero(Floats());
  const MF from = hn::Gt(At(edge.from, rays.u, rays.v), zero), to = hn::Gt(At(edge.to, rays.u, rays.v), zero);
  return kEnters ? hn::AndNot(to, from) : hn::AndNot(from, to);
}

// The key at which they cross it, infinite where they don't.
HWY_INLINE VF KeyOf(const CastEdge& edge, MF crosses, const Rays& rays) {
  const VF key = At(edge.key, rays.u, rays.v);
  return hn::IfThenElse(hn::And(crosses, hn::Lt(key, rays.key_end)), key, hn::Set(Floats(), kInfinity));
}

template <typename Visit>
HWY_INLINE void VisitEdges(const CastEdges& edges, const Visit& visit) {
  for (const std::span<const CastEdge>& run : edges.runs)
    for (const CastEdge& edge : run) visit(edge);
  for (const std::uint32_t i : edges.singles) visit(edges.all[i]);
}

using Kept = TileScratch::Kept;

// Works out all crossings, keeps those that some ray has, and says what they are about `at`.
About CrossFirst(const CastCamera& camera, const Rays& rays, VF at, Kept* kept) {
  const Floats f;
  About about = NothingAbout();
  float* keys = kept->keys;
  VisitEdges(camera.entries, [&](const CastEdge& edge) {
    const MF crosses = Crosses<true>(edge, rays);
    if (hn::AllFalse(f, crosses)) return;
    const VF key = KeyOf(edge, crosses, rays);
    hn::StoreU(key, f, keys);
    keys += hn::Lanes(f);
    kept->edges[kept->entries++] = edge.edge;
    AddEntry(key, at, edge.edge, &about);
  });
  VisitEdges(camera.exits, [&](const CastEdge& edge) {
    const MF crosses = Crosses<false>(edge, rays);
    if (hn::AllFalse(f, crosses)) return;
    const VF key = KeyOf(edge, crosses, rays);
    hn::StoreU(key, f, keys);
    keys += hn::Lanes(f);
    ++kept->exits;
    about.last_exit = LastOf(about.last_exit, key, at);
  });
  return about;
}

// The same again about another key.
About CrossAgain(const Kept& kept, VF at) {
  const Floats f;
  About about = NothingAbout();
  const float* keys = kept.keys;
  for (std::size_t i = 0; i < kept.entries; ++i, keys += hn::Lanes(f))
    AddEntry(hn::LoadU(f, keys), at, kept.edges[i], &about);
  for (std::size_t i = 0; i < kept.exits; ++i, keys += hn::Lanes(f))
    about.last_exit = LastOf(about.last_exit, hn::LoadU(f, keys), at);
  return about;
}

// The lowest bits, one a ray.
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

HWY_INLINE void MoveOn(MF which, const About& about, std::size_t camera, Front* front) {
  const Ints n;
  const auto which_ints = hn::RebindMask(n, which);
  front->key = hn::IfThenElse(which, about.next_entry, front->key);
  front->camera = hn::IfThenElse(which_ints, hn::Set(n, static_cast<std::int32_t>(camera)), front->camera);
  front->edge = hn::IfThenElse(which_ints, about.next_edge, front->edge);
}

// The walk of some rays, from camera to camera, until all agree.
class Walk {
 public:
  Walk(const Rays& rays, std::span<const CastCamera> cameras, std::span<const CastCamera> sights,
       std::size_t first, TileScratch* scratch)
      : rays_(rays),
        cameras_(cameras),
        sights_(sights),
        first_(first),
        keys_(scratch->keys.data()),
        edges_(scratch->edges.data()),
        kept_(scratch->kept) {}

  Front Run(VF key_from, VF key_to) {
    const Floats f;
    Front front{key_from, hn::Set(Ints(), TileHits::kNoCamera), hn::Zero(Ints())};
    MF alive = hn::Le(key_from, key_to);
    for (bool moved = true, is_first = true; moved && !hn::AllFalse(f, alive); is_first = false) {
      moved = false;
      for (std::size_t i = 0; i < cameras_.size(); ++i) {
        const About about = is_first ? First(cameras_[i], i, front.key) : CrossAgain(kept_[i], front.key);
        const MF outside = hn::AndNot(IsInside(about, cameras_[i].starts_inside >> first_), alive);
        if (hn::AllFalse(f, outside)) continue;
        MoveOn(outside, about, i, &front);
        alive = hn::And(alive, hn::Le(front.key, key_to));
        moved = true;
        if (hn::AllFalse(f, alive)) break;
      }
      if (!moved && !sights_.empty() && !hn::AllFalse(f, alive)) {
        moved = MoveIntoSight(alive, &front);
        alive = hn::And(alive, hn::Le(front.key, key_to));
      }
    }
    front.key = hn::IfThenElse(alive, front.key, hn::Set(f, kInfinity));
    return front;
  }

 private:
  About First(const CastCamera& camera, std::size_t i, VF at) {
    Kept& kept = kept_[i];
    kept = {keys_, edges_, 0, 0};
    const About about = CrossFirst(camera, rays_, at, &kept);
    keys_ += (kept.entries + kept.exits) * hn::Lanes(Floats());
    edges_ += kept.entries;
    return about;
  }

  // Rays that no camera sees go on to where one does. Rare enough to work all crossings out anew.
  bool MoveIntoSight(MF alive, Front* front) {
    const Floats f;
    const VF at = front->key;
    MF unseen = alive;
    About nearest = NothingAbout();
    VI camera = hn::Zero(Ints());
    for (std::size_t i = 0; i < sights_.size(); ++i) {
      Kept kept{keys_, edges_, 0, 0};
      const About about = CrossFirst(sights_[i], rays_, at, &kept);
      unseen = hn::AndNot(IsInside(about, sights_[i].starts_inside >> first_), unseen);
      const MF is_nearer = hn::Lt(about.next_entry, nearest.next_entry);
      const auto is_nearer_ints = hn::RebindMask(Ints(), is_nearer);
      nearest.next_entry = hn::IfThenElse(is_nearer, about.next_entry, nearest.next_entry);
      nearest.next_edge = hn::IfThenElse(is_nearer_ints, about.next_edge, nearest.next_edge);
      camera = hn::IfThenElse(is_nearer_ints, hn::Set(Ints(), static_cast<std::int32_t>(cameras_.size() + i)),
                              camera);
    }
    if (hn::AllFalse(f, unseen)) return false;
    MoveOn(unseen, nearest, 0, front);
    front->camera = hn::IfThenElse(hn::RebindMask(Ints(), unseen), camera, front->camera);
    return true;
  }

  const Rays& rays_;
  std::span<const CastCamera> cameras_;
  std::span<const CastCamera> sights_;
  std::size_t first_;
  float* keys_;
  std::uint32_t* edges_;
  std::span<Kept> kept_;
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

std::size_t CountOf(std::span<const CastCamera> cameras) {
  std::size_t count = 0;
  for (const CastCamera& camera : cameras) count += camera.entries.size() + camera.exits.size();
  return count;
}

void Cast(const TileRays& tile, const CastBox& box, std::span<const CastCamera> cameras,
          std::span<const CastCamera> sights, TileScratch* scratch, TileHits* hits) {
  const Floats f;
  const std::size_t lanes = hn::Lanes(f), count = CountOf(cameras) + CountOf(sights);
  scratch->kept.resize(cameras.size());
  if (scratch->keys.size() < count * lanes) scratch->keys.resize(2 * count * lanes);
  if (scratch->edges.size() < count) scratch->edges.resize(2 * count);
  hits->any = false;
  for (std::size_t first = 0; first < kTileRays; first += lanes) {
    const Rays rays{hn::Load(f, tile.u + first), hn::Load(f, tile.v + first), hn::Set(f, tile.key_end)};
    VF key_from = hn::Set(f, -kInfinity), key_to = rays.key_end;
    Clip(box, rays, &key_from, &key_to);
    const Front front = Walk(rays, cameras, sights, first, scratch).Run(key_from, key_to);
    hits->any = hits->any || !hn::AllTrue(f, hn::Eq(front.key, hn::Set(f, kInfinity)));
    hn::Store(front.key, f, hits->key + first);
    hn::Store(front.camera, Ints(), hits->camera + first);
    hn::Store(front.edge, Ints(), hits->edge + first);
  }
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(Cast);

void CastTile(const TileRays& rays, const CastBox& box, std::span<const CastCamera> cameras,
              std::span<const CastCamera> sights, TileScratch* scratch, TileHits* hits) {
  HWY_DYNAMIC_DISPATCH(Cast)(rays, box, cameras, sights, scratch, hits);
}

}  // namespace elbowroom::recon
#endif
