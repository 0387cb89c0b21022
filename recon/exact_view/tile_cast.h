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
  std::uint32_t edge = 0;  // its number in the contour
  bool is_entry = false;   // rays enter the object through it
};

// A key and the number of its edge, packed into two 64-bit words that are gathered for many rays at once: du
// and dv in the first, at_origin and edge in the second.
class CastCrossing {
 public:
  CastCrossing(const CastForm& key, std::int32_t edge)
      : words_{Pack(std::bit_cast<std::uint32_t>(key.du), std::bit_cast<std::uint32_t>(key.dv)),
               Pack(std::bit_cast<std::uint32_t>(key.at_origin), static_cast<std::uint32_t>(edge))} {}
  [[nodiscard]] std::int32_t edge() const { return static_cast<std::int32_t>(words_[1] >> 32U); }
  // The words of consecutive crossings, two for each.
  [[nodiscard]] static const std::uint64_t* Words(const CastCrossing* crossings) { return crossings->words_; }

 private:
  static std::uint64_t Pack(std::uint32_t lower, std::uint32_t upper) {
    return lower | std::uint64_t{upper} << 32U;
  }
  std::uint64_t words_[2];
};

// Intervals of a ray's angle. All rays whose angle is in one interval meet the same edges in the same order.
// Interval i is [begins[i], begins[i + 1]); begins[0] is -infinity, the last one infinity.
struct CastIntervals {
  std::vector<float> begins;
  // The place in `crossings` of each interval's first crossing, and one more at the end. The last crossing of
  // an interval is two places before the first of the next: between them stands the end of the list.
  std::vector<std::int32_t> firsts;
  // The crossings of one interval after another, each in its order along the rays: entries and exits
  // alternate. The edge is a number in CastPencil::edges. After each interval's last crossing, and in place
  // 0, stands a crossing with an infinite key. No ray passes it, so that a list needs no length.
  std::vector<CastCrossing> crossings;
  // Bins of equal width over the angles, each a packed CastBin. A ray begins to look for its interval in its
  // bin.
  std::vector<std::uint64_t> bins;

  struct Run {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  [[nodiscard]] std::size_t size() const { return begins.size() - 1; }
  [[nodiscard]] Run RunOf(std::size_t interval) const {
    return {static_cast<std::size_t>(firsts[interval]), static_cast<std::size_t>(firsts[interval + 1] - 1)};
  }
  void Add(const CastForm& key, std::int32_t edge) { crossings.push_back(CastCrossing(key, edge)); }
};

// Which intervals a bin of angles reaches into.
struct CastBin {
  std::uint32_t interval = 0;  // the first of them
  bool has_more = false;       // there are more than two
  float next = 0.0F;           // the angle at which the second begins

  [[nodiscard]] std::uint64_t Pack() const {
    return interval | (has_more ? 1U << 31U : 0U) | std::uint64_t{std::bit_cast<std::uint32_t>(next)} << 32U;
  }
  [[nodiscard]] static std::size_t IntervalOf(std::uint64_t bin) { return bin & 0x7FFFFFFFU; }
};

// One camera's contour, prepared for the rays of one view.
struct CastPencil {
  // The angle of the ray (u, v) is PencilAngle(x(u, v), y(u, v)).
  CastForm x;
  CastForm y;
  // Bin i begins at least_angle + i / bins_per_angle.
  float least_angle = -2.0F;
  float bins_per_angle = 1.0F;
  std::vector<CastEdge> edges;
  CastIntervals intervals;
  bool starts_inside = false;  // rays start in the object: their first crossing is an exit

  [[nodiscard]] bool IsEntry(const CastIntervals::Run& run, std::size_t place) const {
    return ((place - run.begin) % 2 != 0) == starts_inside;
  }

  // 0: no ray meets an edge, and a ray has one label all along.
  [[nodiscard]] std::uint32_t bins() const { return static_cast<std::uint32_t>(intervals.bins.size()); }
};

// Grows with the angle of (x, y), from -2 at the negative x axis over 0 at the positive one to 2. It takes
// one division and no arc tangent. Near 0 its error is two roundings of its own size.
template <typename Real>
[[nodiscard]] Real PencilAngle(Real x, Real y) {
  const Real size = (x < 0 ? -x : x) + (y < 0 ? -y : y);
  const Real share = y / size;
  return x < 0 ? (y < 0 ? -2 - share : 2 - share) : share;
}

// The part of the ray (u, v) that is in the workspace: from the largest of the keys `not_before` to the
// smallest of the keys `not_after`; nothing if one of `beside` is negative.
struct CastBox {
  std::vector<CastForm> not_before;
  std::vector<CastForm> not_after;
  std::vector<CastForm> beside;
};

struct TileRays {
  alignas(64) float u[kTileRays];  // NaN: no ray
  alignas(64) float v[kTileRays];
  // Perspective: keys are -1 / depth_mm, and a ray ends at key 0. Orthographic: keys are depths, and a ray
  // has no end.
  bool is_perspective = true;
};

// One camera's pencil. Bit i of starts_inside: ray i of the tile starts where the camera says object.
struct TileCamera {
  const CastPencil* pencil = nullptr;
  std::uint32_t starts_inside = 0;
};

// For each ray the depth of its first point in the hull, and the camera whose edge that point is on
// (kNoCamera: a face of the workspace). 0 and kMiss if the ray has no such point, or if a perspective ray
// starts in it.
struct TileHits {
  static constexpr std::int32_t kNoCamera = -1;
  static constexpr std::int32_t kMiss = -2;
  alignas(64) float depth_mm[kTileRays];
  alignas(64) std::int32_t camera[kTileRays];  // visibility_outlines are numbered after the cameras
  alignas(64) std::int32_t edge[kTileRays];    // if wanted: number in CastPencil::edges, for hits on edges
  int count = 0;
};

// Working memory, kept from tile to tile.
struct TileScratch {
  // One camera's next crossing with each ray, and the label before it.
  struct Course {
    alignas(64) float key[kTileRays];
    alignas(64) std::int32_t place[kTileRays];      // in CastIntervals
    alignas(64) std::int32_t is_inside[kTileRays];  // all bits, or none
  };
  std::vector<Course> courses;     // cameras', then visibility_outlines'
  std::int64_t crossings_met = 0;  // crossings of rays with edges that were worked out so far
};

// A point is in the hull if all `cameras` say object and, where there are `visibility_outlines`, one of them
// does, too. The width of the processor's vectors decides how many rays are cast at once. It doesn't change a
// bit of the result (tile_cast_test).
void CastTile(const TileRays& rays, const CastBox& box, std::span<const TileCamera> cameras,
              std::span<const TileCamera> visibility_outlines, bool wants_edges, TileScratch* scratch,
              TileHits* hits);

}  // namespace elbowroom::recon
