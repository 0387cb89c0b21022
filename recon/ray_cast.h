// Where rays meet the hull: sphere tracing with certified steps, no planes and no plane-spacing error.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera_model.h"
#include "recon/ray.h"
#include "recon/visual_hull.h"

namespace elbowroom::recon {

struct RayOptions {
  // Where no larger step is certain the ray advances by this much: a stretch of hull shorter than it can be
  // missed, nothing longer can.
  double step_mm = 0.05;
  double from_mm = 0.0;  // search from here ...
  double to_mm = 1e9;    // ... to here
};

// Distance along the ray of the first point inside the hull, refined to 1e-6 mm between the last point known
// to be outside and the first known inside; from_mm itself if the ray starts inside.
[[nodiscard]] std::optional<double> FirstInside(const VisualHull& hull, const Ray& ray,
                                                const RayOptions& options = {});

// Distance along the ray of the first point outside the hull; from_mm itself if it starts outside. Nothing
// if the ray stays inside up to to_mm.
[[nodiscard]] std::optional<double> FirstOutside(const VisualHull& hull, const Ray& ray,
                                                 const RayOptions& options = {});

// The hull as a camera sees it.
struct HullView {
  int width_px = 0;
  int height_px = 0;
  // Along the camera's z axis; 0 where the ray misses, and everywhere for a camera inside the hull.
  std::vector<float> depth_mm;
  std::vector<Eigen::Vector3f> normal_in_world;  // unit, out of the hull; zero where the ray misses
  std::int64_t hit_pixels = 0;
  std::int64_t probes = 0;          // point queries asked
  std::int64_t skipped_pixels = 0;  // settled by a beam or by the workspace, without a ray of their own
};

// First hull surface along the ray through each pixel's centre, refined to step_mm / 256. Beams over 8 x 8
// tiles march first and hand their rays a start; a beam that leaves the workspace settles its tile. Parallel
// over tiles; the result doesn't depend on the number of threads.
[[nodiscard]] HullView ViewHull(const VisualHull& hull, const core::CameraModel& view, double step_mm = 0.25);

}  // namespace elbowroom::recon
