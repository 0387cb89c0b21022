// A value for each pixel of a view that shows the hull's surface.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"

namespace elbowroom::recon {

// Row-major, one a pixel. Nothing where the ray misses the hull, and on a face of the workspace, of a section
// plane, or of a camera's picture that ends: no silhouette bounds the hull there.
using SurfaceValues = std::vector<std::optional<float>>;

// Where the ray of a pixel meets what is `depth_mm` away along the view's z axis.
[[nodiscard]] inline Eigen::Vector3d PlaceInView(const ViewRays& rays, int x, int y, double depth_mm) {
  const Eigen::Vector2d uv = rays.At(x, y);
  if (rays.projection() == Projection::kOrthographic) return {uv.x(), uv.y(), depth_mm};
  return {uv.x() * depth_mm, uv.y() * depth_mm, depth_mm};
}

}  // namespace elbowroom::recon
