// The rays of one small tile, cast at the edges they can meet: the inner loop of the exact view.
#pragma once

#include <bit>
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
  bool is_entry = false;   // rays enter the object by it
};

// An edge in the list of those that a ray meets.
struct CastCrossing {
  CastForm key;
  std::uint32_t edge = 0;  // number in CastPencil::edges, below 2^31
  bool is_entry = false;   // rays enter the object by it

  // As rays gather it.
  struct Words {
    std::uint64_t slopes = 0;  // the key's du, dv
    std::uint64_t rest = 0;    // its at_origin; is_entry; edge
    [[nodiscard]] bool is_entry() const { return ((rest >> 32U) & 1U) != 0; }
  };
  [[nodiscard]] Words Pack() const {
    const auto bits = [](float real) { return std::uint64_t{std::bit_cast<std::uint32_t>(real)}; };
    const std::uint64_t tag = 2 * std::uint64_t{edge} + (is_entry ? 1 : 0);
    return {bits(key.du) | bits(key.dv) << 32U, bits(key.at_origin) | tag << 32U};
  }
  [[nodiscard]] static CastCrossing Unpack(const Words& words) {
    const auto real = [](std::uint64_t bits) {
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    };
    return {{real(words.slopes), real(words.slopes >> 32U), real(words.rest)},
            static_cast<std::uint32_t>(words.rest >> 33U),
            words.is_entry()};
  }
};

// Angles in which rays meet the same edges, in the same order: [begins[i], begins[i + 1]) is interval i.
// begins[0] is -infinity, the last one infinity. Packed into words, which rays gather.
struct CastIntervals {
  std::vector<float> begins;
  // By interval: the first of its crossings, and past the last, in their order along the rays, entries and
  // exits in turn.
  std::vector<std::uint64_t> runs;
  // CastCrossing::Words one after the other; one crossing more than there are.
  std::vector<std::uint64_t> crossings;
  // By bin: no later than the interval of any ray whose angle is in the bin.
  std::vector<std::int32_t> first_interval;

  struct Run {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  [[nodiscard]] std::size_t size() const { return runs.size(); }
  [[nodiscard]] Run RunOf(std::size_t interval) const {
    return {runs[interval] & 0xFFFFFFFFU, runs[interval] >> 32U};
  }
  [[nodiscard]] CastCrossing CrossingAt(std::size_t place) const {
    return CastCrossing::Unpack({crossings[2 * place], crossings[2 * place + 1]});
  }
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
  std::vector<CastEdge> edges;
  CastIntervals intervals;
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
  // Perspective: keys are -1 / depth_mm and end at 0; otherwise they are depths, and don't end.
  bool is_perspective = true;
};

// One camera's pencil, and the labels that the tile's rays come with, a bit a ray.
struct TileCamera {
  const CastPencil* pencil = nullptr;
  std::uint32_t starts_inside = 0;
};

// Of each ray: the depth of its first point in the hull, and whose edge it is on (kNoCamera: a face of the
// workspace). 0 and kMiss if there is none or if that is where perspective rays start.
struct TileHits {
  static constexpr std::int32_t kNoCamera = -1;
  static constexpr std::int32_t kMiss = -2;
  alignas(64) float depth_mm[kTileRays];
  alignas(64) std::int32_t camera[kTileRays];  // sights count on after the cameras
  alignas(64) std::int32_t edge[kTileRays];    // if wanted: number in CastPencil::edges, of hits on edges
  int count = 0;
};

// Room to work in, kept from tile to tile.
struct TileScratch {
  // One camera's next crossing with each ray, and what the one before said.
  struct Course {
    alignas(64) float key[kTileRays];
    alignas(64) std::int32_t place[kTileRays];  // in CastIntervals::crossings
    alignas(64) std::int32_t end[kTileRays];
    alignas(64) std::int32_t is_entry[kTileRays];   // all bits, or none
    alignas(64) std::int32_t is_inside[kTileRays];  // likewise
  };
  std::vector<Course> courses;     // cameras', then sights'
  std::int64_t crossings_met = 0;  // of rays with edges, worked out so far
};

// `cameras` must all agree that a point is in the hull, and one of `sights` if there are any. The processor's
// widest vectors decide how many rays go at once, never the result: the same bits for all (hull_view_test).
void CastTile(const TileRays& rays, const CastBox& box, std::span<const TileCamera> cameras,
              std::span<const TileCamera> sights, bool wants_edges, TileScratch* scratch, TileHits* hits);

}  // namespace elbowroom::recon
