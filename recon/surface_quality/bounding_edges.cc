#include "recon/surface_quality/bounding_edges.h"

#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

BoundingEdges::BoundingEdges(const VisualHull& hull) {
  for (const auto& silhouette : hull.silhouettes())
    contour_edges_.push_back(silhouette->labels().contour().edges.size());
}

}  // namespace elbowroom::recon
