// Which pixels of a view show a silhouette's own edge, and whose.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/surface_quality/surface_values.h"

namespace elbowroom::recon {

// For one hull. Thread: any.
class BoundingEdges {
 public:
  explicit BoundingEdges(const VisualHull& hull);

  // The camera whose silhouette bounds the hull there. Nothing: none does, as SurfaceValues says.
  [[nodiscard]] std::optional<core::CameraIndex> CameraOf(const HullSurface& surface) const {
    const std::optional<core::CameraIndex> camera = surface.camera();
    // Under `abstain` the edges of a picture's outline follow the contour's.
    if (!camera || surface.edge() >= contour_edges_[*camera]) return std::nullopt;
    return camera;
  }

 private:
  std::vector<std::size_t> contour_edges_;  // by camera
};

// What `value` says of each pixel whose place a camera's silhouette bounds, from that camera, the place and
// the surface's normal there; `hull`: what the picture is of. Parallel: `value` is called on several threads.
// Throws: PreconditionError: the picture has no surfaces or normals, or its size isn't that of `rays`.
using ValueAt = std::function<float(core::CameraIndex bounding, const Eigen::Vector3d& x_in_world,
                                    const Eigen::Vector3d& normal_in_world)>;
[[nodiscard]] SurfaceValues ValuesOf(const VisualHull& hull, const HullView& picture, const ViewRays& rays,
                                     const ValueAt& value);

}  // namespace elbowroom::recon
