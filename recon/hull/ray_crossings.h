// Where a ray is in the hull: exactly, by its crossings with the silhouettes' edges.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "recon/hull/ray.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

struct CrossingScratch;  // recon/hull/crossing_scratch.h

// The bound of the hull at one end of an interval: an edge of a camera's contour, or else a face of the
// workspace or the end of the search.
struct HullBoundary {
  std::optional<core::CameraIndex> camera;
  std::uint32_t edge = 0;  // of that camera's contour, or of its picture's outline
  bool is_outline = false;
};

// A stretch of a ray inside the hull, from_mm < to_mm along it.
struct HullInterval {
  double from_mm = 0.0;
  double to_mm = 0.0;
  HullBoundary entry;
  HullBoundary exit;
};

struct RaySpan {
  double from_mm = 0.0;  // >= 0
  double to_mm = std::numeric_limits<double>::infinity();
};

// All intervals within the span, from the near end. A ray's picture is a straight line that begins at the
// epipole; the ray crosses a silhouette where this line crosses the contour. So there is no step to choose,
// and no part of the hull is too thin to be found (ray_crossings_test). Cost follows the number of the
// contours' edges. Throws: PreconditionError for a direction that isn't unit, a span that isn't 0 <= from <=
// to.
[[nodiscard]] std::vector<HullInterval> IntervalsInHull(const VisualHull& hull, const Ray& ray,
                                                        const RaySpan& span = {});
// The same in the scratch's memory: valid until its next use.
[[nodiscard]] std::span<const HullInterval> IntervalsInHull(const VisualHull& hull, const Ray& ray,
                                                            const RaySpan& span, CrossingScratch* scratch);

// Distance along the ray of the first point of the hull; from_mm itself if the span starts inside.
[[nodiscard]] std::optional<double> FirstInside(const VisualHull& hull, const Ray& ray,
                                                const RaySpan& span = {});
[[nodiscard]] std::optional<double> FirstInside(const VisualHull& hull, const Ray& ray, const RaySpan& span,
                                                CrossingScratch* scratch);

// Distance along the ray of the first point that isn't in the hull; from_mm itself if the span starts
// outside. Nothing if the ray stays inside up to to_mm.
[[nodiscard]] std::optional<double> FirstOutside(const VisualHull& hull, const Ray& ray,
                                                 const RaySpan& span = {});

}  // namespace elbowroom::recon
