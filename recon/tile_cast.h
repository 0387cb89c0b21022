// The rays of one small tile, cast at the edges they can meet: the inner loop of the exact view.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace elbowroom::recon {

inline constexpr int kTilePx = 4;
inline constexpr int kTileRays = kTilePx * kTilePx;

// value(u, v) = u * du + v * dv + at_origin, in float32.
struct CastForm {
  float du = 0.0F;
  float dv = 0.0F;
  float at_origin = 0.0F;
};

// The surface that one edge sweeps, from the camera's centre outwards. The ray (u, v) meets it at key(u, v),
// provided that the ends' sides agree with the kind: entering the object, from > 0 and not to > 0; leaving
// it, not from > 0 and to > 0. Derivation: docs/exact_view.md.
struct CastEdge {
  CastForm from;  // side of the epipolar plane that the edge's ends are on
  CastForm to;
  CastForm key;
  std::uint32_t edge = 0;  // of the contour
};

// Some of a pencil's edges: two runs of neighbours, and single ones.
struct CastEdges {
  std::array<std::span<const CastEdge>, 2> runs;
  const CastEdge* all = nullptr;
  std::span<const std::uint32_t> singles;  // numbers in `all`

  [[nodiscard]] std::size_t size() const { return runs[0].size() + runs[1].size() + singles.size(); }
};

// What one camera can tell the tile's rays.
struct CastCamera {
  CastEdges entries;  // edges that rays enter the object by
  CastEdges exits;
  std::uint32_t starts_inside = 0;  // a bit a ray: the label that it comes with
};

// Where rays (u, v) are in the workspace: not before the largest of some keys, not after the smallest of
// others, and only where all of `beside` aren't negative.
struct CastBox {
  std::vector<CastForm> not_before;
  std::vector<CastForm> not_after;
  std::vector<CastForm> beside;
};

struct TileRays {
  alignas(64) float u[kTileRays];  // NaN: no ray
  alignas(64) float v[kTileRays];
  float key_end = 0.0F;  // of the rays themselves: 0 perspective, infinite orthographic
};

// Of each ray: the key of its first point in the hull, infinite if there is none, and whose edge it is on
// (kNoCamera: a face of the workspace).
struct TileHits {
  static constexpr std::int32_t kNoCamera = -1;
  alignas(64) float key[kTileRays];
  alignas(64) std::int32_t camera[kTileRays];  // sights count on after the cameras
  alignas(64) std::int32_t edge[kTileRays];
  bool any = false;
};

// Room to work in, kept from tile to tile.
struct TileScratch {
  // One camera's crossings with the rays of one vector: keys, a vector each, entries first.
  struct Kept {
    float* keys = nullptr;
    std::uint32_t* edges = nullptr;  // of the entries
    std::size_t entries = 0;
    std::size_t exits = 0;
  };

  std::vector<Kept> kept;
  std::vector<float> keys;
  std::vector<std::uint32_t> edges;
};

// `cameras` must all agree that a point is in the hull, and one of `sights` if there are any. The processor's
// widest vectors decide how many rays go at once, never the result: the same bits for all (hull_view_test).
void CastTile(const TileRays& rays, const CastBox& box, std::span<const CastCamera> cameras,
              std::span<const CastCamera> sights, TileScratch* scratch, TileHits* hits);

}  // namespace elbowroom::recon
