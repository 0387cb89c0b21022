// Which pixels of a view show a silhouette's own edge, and whose.
#pragma once

#include <optional>
#include <vector>

#include "core/ids.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull_declared.h"

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

}  // namespace elbowroom::recon
