// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/tile_cast.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

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
using MF = hn::Mask<Floats>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// No fused operation: it would round differently on processors without one.
VF At(const TileForm& form, VF u, VF v) {
  const Floats f;
  return hn::Add(hn::Add(hn::Mul(u, hn::Set(f, form.du)), hn::Mul(v, hn::Set(f, form.dv))),
                 hn::Set(f, form.at_centre));
}

// The keys at which rays cross one kind of edge, infinite where they don't, one vector an edge into `keys`.
void CrossingKeys(const std::vector<TileEdge>& edges, bool enters, VF u, VF v, VF key_end, float* keys) {
  const Floats f;
  const VF zero = hn::Zero(f), infinity = hn::Set(f, kInfinity);
  for (const TileEdge& edge : edges) {
    const MF from = hn::Gt(At(edge.from, u, v), zero), to = hn::Gt(At(edge.to, u, v), zero);
    const MF crosses = enters ? hn::AndNot(to, from) : hn::AndNot(from, to);
    const VF key = At(edge.key, u, v);
    hn::Store(hn::IfThenElse(hn::And(crosses, hn::Lt(key, key_end)), key, infinity), f, keys);
    keys += hn::Lanes(f);
  }
}

// The lowest bits, one a ray.
MF MaskOf(std::uint64_t bits) {
  const Floats f;
  if (bits == 0) return hn::Gt(hn::Zero(f), hn::Zero(f));
  alignas(64) float lanes[kTileRays];
  for (std::size_t i = 0; i < hn::Lanes(f); ++i) lanes[i] = ((bits >> i) & 1U) != 0 ? 1.0F : 0.0F;
  return hn::Gt(hn::Load(f, lanes), hn::Zero(f));
}

// The last of the crossings up to `at`, minus infinity without one.
VF LastUpTo(const float* keys, std::size_t count, VF at) {
  const Floats f;
  const VF none = hn::Set(f, -kInfinity);
  VF last = none;
  for (std::size_t i = 0; i < count; ++i) {
    const VF key = hn::Load(f, keys + i * hn::Lanes(f));
    last = hn::Max(last, hn::IfThenElse(hn::Le(key, at), key, none));
  }
  return last;
}

MF IsInside(const TileCrossings& crossings, VF at) {
  const Floats f;
  const VF entry = LastUpTo(crossings.entries, crossings.entry_count, at);
  const VF exit = LastUpTo(crossings.exits, crossings.exit_count, at);
  const MF none = hn::Eq(hn::Max(entry, exit), hn::Set(f, -kInfinity));
  return hn::Or(hn::Gt(entry, exit), hn::And(none, MaskOf(crossings.starts_inside)));
}

// Where rays are now, and what brought them there.
struct Front {
  VF key;
  hn::Vec<Ints> camera;
  hn::Vec<Ints> entry;
};

// The first entry beyond `at`, with its number from `number_offset` on.
struct Next {
  VF key;
  hn::Vec<Ints> entry;
};
Next NextEntry(const TileCrossings& crossings, VF at, std::size_t number_offset) {
  const Floats f;
  const Ints n;
  const VF infinity = hn::Set(f, kInfinity);
  Next next{infinity, hn::Zero(n)};
  for (std::size_t i = 0; i < crossings.entry_count; ++i) {
    const VF key = hn::Load(f, crossings.entries + i * hn::Lanes(f));
    const MF is_nearer = hn::And(hn::Gt(key, at), hn::Lt(key, next.key));
    next.key = hn::IfThenElse(is_nearer, key, next.key);
    next.entry = hn::IfThenElse(hn::RebindMask(n, is_nearer),
                                hn::Set(n, static_cast<std::int32_t>(number_offset + i)), next.entry);
  }
  return next;
}

// Moves the rays of `which` on to `next`.
void MoveOn(MF which, const Next& next, std::size_t camera, Front* front) {
  const Ints n;
  front->key = hn::IfThenElse(which, next.key, front->key);
  front->camera =
      hn::IfThenElse(hn::RebindMask(n, which), hn::Set(n, static_cast<std::int32_t>(camera)), front->camera);
  front->entry = hn::IfThenElse(hn::RebindMask(n, which), next.entry, front->entry);
}

// Moves rays of `alive` that no camera sees on to where one does. Returns those that moved.
MF MoveIntoSight(std::span<const TileCrossings> sights, const Tile& tile, MF alive, Front* front) {
  MF unseen = alive;
  for (const TileCrossings& sight : sights) unseen = hn::AndNot(IsInside(sight, front->key), unseen);
  if (hn::AllFalse(Floats(), unseen)) return unseen;
  const VF at = front->key;
  front->key = hn::IfThenElse(unseen, hn::Set(Floats(), kInfinity), front->key);
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const Next next = NextEntry(sights[i], at, tile.cameras[i].entries.size());
    MoveOn(hn::And(unseen, hn::Lt(next.key, front->key)), next, i, front);
  }
  return unseen;
}

// The first key at which all cameras agree; infinite if that isn't before `key_to`.
Front FirstAgreement(std::span<const TileCrossings> cameras, std::span<const TileCrossings> sights,
                     const Tile& tile, VF key_from, VF key_to) {
  const Floats f;
  const Ints n;
  Front front{key_from, hn::Set(n, Tile::kNoCamera), hn::Zero(n)};
  MF alive = hn::Le(key_from, key_to);
  bool moved = true;
  while (moved && !hn::AllFalse(f, alive)) {
    moved = false;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const MF outside = hn::AndNot(IsInside(cameras[i], front.key), alive);
      if (hn::AllFalse(f, outside)) continue;
      MoveOn(outside, NextEntry(cameras[i], front.key, 0), i, &front);
      alive = hn::And(alive, hn::Le(front.key, key_to));
      moved = true;
      if (hn::AllFalse(f, alive)) break;
    }
    if (!moved && !sights.empty()) {
      moved = !hn::AllFalse(f, MoveIntoSight(sights, tile, alive, &front));
      alive = hn::And(alive, hn::Le(front.key, key_to));
    }
  }
  front.key = hn::IfThenElse(alive, front.key, hn::Set(f, kInfinity));
  return front;
}

std::size_t EdgeCount(const std::vector<TileCamera>& cameras) {
  std::size_t count = 0;
  for (const TileCamera& camera : cameras) count += camera.entries.size() + camera.exits.size();
  return count;
}

// Works out the crossings of each camera with the rays from `first` on; returns where free room begins.
float* CrossAll(const std::vector<TileCamera>& cameras, const Tile& tile, std::size_t first, float* keys,
                std::vector<TileCrossings>* crossings) {
  const Floats f;
  const VF u = hn::Load(f, tile.u + first), v = hn::Load(f, tile.v + first);
  const VF key_end = hn::Set(f, tile.key_end);
  for (const TileCamera& camera : cameras) {
    float* exits = keys + camera.entries.size() * hn::Lanes(f);
    CrossingKeys(camera.entries, true, u, v, key_end, keys);
    CrossingKeys(camera.exits, false, u, v, key_end, exits);
    crossings->push_back(
        {keys, camera.entries.size(), exits, camera.exits.size(), camera.starts_inside >> first});
    keys = exits + camera.exits.size() * hn::Lanes(f);
  }
  return keys;
}

void CastVector(Tile* tile, std::size_t first, float* keys) {
  const Floats f;
  const Ints n;
  tile->crossings.clear();
  keys = CrossAll(tile->cameras, *tile, first, keys, &tile->crossings);
  CrossAll(tile->sights, *tile, first, keys, &tile->crossings);
  const std::span<const TileCrossings> all = tile->crossings;
  const Front front =
      FirstAgreement(all.first(tile->cameras.size()), all.subspan(tile->cameras.size()), *tile,
                     hn::Load(f, tile->key_from + first), hn::Load(f, tile->key_to + first));
  hn::Store(front.key, f, tile->key + first);
  hn::Store(front.camera, n, tile->camera + first);
  hn::Store(front.entry, n, tile->entry + first);
}

void Cast(Tile* tile) {
  const std::size_t lanes = hn::Lanes(Floats());
  const std::size_t floats = (EdgeCount(tile->cameras) + EdgeCount(tile->sights)) * lanes;
  constexpr std::size_t kAlignment = 64;
  if (tile->keys.size() < floats + kAlignment) tile->keys.resize(2 * floats + kAlignment);
  const auto address = reinterpret_cast<std::uintptr_t>(tile->keys.data());
  float* keys = tile->keys.data() + (kAlignment - address % kAlignment) % kAlignment / sizeof(float);
  for (std::size_t first = 0; first < kTileRays; first += lanes) CastVector(tile, first, keys);
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(Cast);

void CastTile(Tile* tile) { HWY_DYNAMIC_DISPATCH(Cast)(tile); }

}  // namespace elbowroom::recon
#endif
