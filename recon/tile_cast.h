// The rays of one 8 x 8 tile, cast at the edges they can meet: the inner loop of the exact view.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace elbowroom::recon {

inline constexpr int kTilePx = 8;
inline constexpr int kTileRays = kTilePx * kTilePx;

// value(u, v) = u * du + v * dv + at_centre; u and v count from the tile's own centre, so that float32 keeps
// what the tile can tell apart.
struct TileForm {
  float du = 0.0F;
  float dv = 0.0F;
  float at_centre = 0.0F;
};

// A PencilEdge about the tile's centre.
struct TileEdge {
  TileForm from;
  TileForm to;
  TileForm key;
  std::uint32_t edge = 0;  // of the contour
};

// What one camera can tell the tile's rays.
struct TileCamera {
  std::vector<TileEdge> entries;  // edges that rays enter the object by
  std::vector<TileEdge> exits;
  std::uint64_t starts_inside = 0;  // a bit a ray: the label that it comes with

  void Clear() {
    entries.clear();
    exits.clear();
    starts_inside = 0;
  }
};

// Where the rays of one vector cross one camera's edges: a vector of keys an edge.
struct TileCrossings {
  const float* entries = nullptr;
  std::size_t entry_count = 0;
  const float* exits = nullptr;
  std::size_t exit_count = 0;
  std::uint64_t starts_inside = 0;
};

struct Tile {
  alignas(64) float u[kTileRays];
  alignas(64) float v[kTileRays];
  // Where each ray is in the workspace; from > to: nowhere.
  alignas(64) float key_from[kTileRays];
  alignas(64) float key_to[kTileRays];
  float key_end = 0.0F;  // of the rays themselves: 0 perspective, infinite orthographic
  std::vector<TileCamera> cameras;
  std::vector<TileCamera>
      sights;  // of pictures' outlines, one of which must hold a point; none: no such rule
  // Out: the key of each ray's first point in the hull, infinite if there is none; which camera's edge it is
  // on (kNoCamera: a face of the workspace).
  static constexpr std::int32_t kNoCamera = -1;
  alignas(64) float key[kTileRays];
  alignas(64) std::int32_t camera[kTileRays];
  alignas(
      64) std::int32_t entry[kTileRays];  // number of that edge among the camera's entries, then its sight's
  std::vector<float> keys;                // room to work in
  std::vector<TileCrossings> crossings;
};

// The processor's widest vectors decide how many rays go at once, never the result: the same bits for all
// (tile_cast_test).
void CastTile(Tile* tile);

}  // namespace elbowroom::recon
