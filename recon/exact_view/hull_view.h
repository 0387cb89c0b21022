// The hull as a camera sees it, exactly: no planes, no steps.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/camera_model.h"
#include "core/ids.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/images/picture_buffer.h"

namespace elbowroom::recon {

// The surface at a pixel: an edge of a camera's contour, seen from that camera, or a face: of the workspace,
// or the plane of one of the rays' half-spaces.
class HullSurface {
 public:
  HullSurface() = default;  // none: the ray misses
  [[nodiscard]] static HullSurface Workspace() { return HullSurface(1U); }
  // Cameras up to 253, edges up to 2^24 - 1; under `abstain` the edges of the outline follow the contour's.
  HullSurface(core::CameraIndex camera, std::uint32_t edge)
      : packed_(static_cast<std::uint32_t>((camera + 2) << 24U) | edge) {}

  [[nodiscard]] bool is_hit() const { return packed_ != 0; }
  // Nothing for a face, and for a miss.
  [[nodiscard]] std::optional<core::CameraIndex> camera() const {
    if (packed_ >> 24U < 2) return std::nullopt;
    return (packed_ >> 24U) - 2;
  }
  [[nodiscard]] std::uint32_t edge() const { return packed_ & 0xFFFFFFU; }
  [[nodiscard]] bool operator==(const HullSurface&) const = default;

 private:
  explicit HullSurface(std::uint32_t packed) : packed_(packed) {}
  std::uint32_t packed_ = 0;
};

// Pixels [x, right) by [y, bottom).
struct PixelBox {
  int x = 0;
  int y = 0;
  int right = 0;
  int bottom = 0;
};

struct HullView {
  int width_px = 0;
  int height_px = 0;
  // Along the view's z axis; 0 where the ray misses, and where a perspective view's centre is in the hull.
  PictureBuffer<float> depth_mm;
  PictureBuffer<HullSurface> surface;
  PictureBuffer<Eigen::Vector3f> normal_in_world;  // unit, out of the hull; zero where the ray misses
  std::int64_t hit_pixels = 0;
  PixelBox hits;                    // a box that holds them
  std::int64_t cast_pixels = 0;     // whose rays were cast
  std::int64_t skipped_pixels = 0;  // their rays weren't cast: a whole square misses the hull
  std::int64_t edges = 0;           // of all contours
  std::int64_t crossings_met = 0;   // crossings of rays with edges that were worked out
};

struct HullViewOptions {
  bool surfaces = true;  // fill `surface`; otherwise it stays empty
  bool normals = true;   // fill `normal_in_world`; otherwise it stays empty
};

// The first point of the hull along each ray, found where the ray's picture in each camera crosses the
// contours. Rays end at the workspace's faces and at their half-spaces' planes, which close the hull there.
// Exact but for float32: 1e-6 of the depth (hull_view_test). Squares of pixels whose rays certainly
// miss the hull are skipped. Parallel; the result depends neither on the number of threads nor on the
// processor's vector width. `kept`: a view that isn't needed any more. Its memory is used again, and if it
// has the same size and options only its box of hits is cleared.
[[nodiscard]] HullView ViewHull(const VisualHull& hull, const ViewRays& rays,
                                const HullViewOptions& options = {}, HullView kept = {});

// The same, for a view that is used once.
[[nodiscard]] HullView ViewHull(const VisualHull& hull, const core::CameraModel& view,
                                const HullViewOptions& options = {});

}  // namespace elbowroom::recon
