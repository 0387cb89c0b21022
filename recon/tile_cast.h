// The rays of one small tile, cast at the edges they can meet: the inner loop of the exact view.
#pragma once

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

// The surface that one edge sweeps, from the camera's centre outwards: rays whose angle is at least `from`
// and less than `to` meet it at key(u, v). Derivation: docs/exact_view.md.
struct CastEdge {
  float from = 0.0F;
  float to = 0.0F;
  CastForm key;
  std::uint32_t edge = 0;  // of the contour
};

// Edges by the angular bin in which they begin, and of each bin those that began before it.
struct CastEdges {
  std::vector<CastEdge> edges;
  std::vector<std::uint32_t> first;          // in `edges`, by bin; one more at the end
  std::vector<std::uint32_t> carried;        // numbers in `edges`
  std::vector<std::uint32_t> first_carried;  // in `carried`, by bin; one more at the end
};

// All that one camera can tell a view's rays.
struct CastPencil {
  // A ray's angle is that of (x(u, v), y(u, v)), as PencilAngle takes it.
  CastForm x;
  CastForm y;
  // Of bin i: from least_angle + i / bins_per_angle on.
  float least_angle = -2.0F;
  float bins_per_angle = 1.0F;
  std::uint32_t bins = 0;
  CastEdges entries;  // edges that rays enter the object by
  CastEdges exits;
};

// -2 to 2 for a turn from the negative x axis on, 0 along the positive one, where it is exact to the last
// bit.
template <typename Real>
[[nodiscard]] Real PencilAngle(Real x, Real y) {
  const Real size = (x < 0 ? -x : x) + (y < 0 ? -y : y);
  const Real share = y / size;
  return x < 0 ? (y < 0 ? -2 - share : 2 - share) : share;
}

// Where rays (u, v) are in the workspace: not before the largest of some keys, not after the smallest of
// others, and only where none of `beside` is negative.
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

// One camera's pencil, and the labels that the tile's rays come with, a bit a ray.
struct TileCamera {
  const CastPencil* pencil = nullptr;
  std::uint32_t starts_inside = 0;
};

// Of each ray: the key of its first point in the hull, infinite if there is none, and whose edge it is on
// (kNoCamera: a face of the workspace).
struct TileHits {
  static constexpr std::int32_t kNoCamera = -1;
  alignas(64) float key[kTileRays];
  alignas(64) std::int32_t camera[kTileRays];  // sights count on after the cameras
  alignas(64) std::int32_t edge[kTileRays];    // if wanted; of hits on edges
  bool any = false;
};

// Room to work in, kept from tile to tile.
struct TileScratch {
  // One camera's crossings with the rays of one vector, as they were worked out.
  struct Kept {
    std::size_t entry_keys = 0;  // in `keys`
    std::size_t entries = 0;
    std::size_t exit_keys = 0;
    std::size_t exits = 0;
    bool has_exits = false;
    std::uint32_t first_bin = 0;  // of the rays' angles
    std::uint32_t last_bin = 0;
  };
  std::vector<Kept> kept;
  std::vector<float> keys;     // a vector a crossing
  std::int64_t edges_met = 0;  // angular intervals that rays were compared with, so far
};

// `cameras` must all agree that a point is in the hull, and one of `sights` if there are any. The processor's
// widest vectors decide how many rays go at once, never the result: the same bits for all (hull_view_test).
void CastTile(const TileRays& rays, const CastBox& box, std::span<const TileCamera> cameras,
              std::span<const TileCamera> sights, bool wants_edges, TileScratch* scratch, TileHits* hits);

}  // namespace elbowroom::recon
