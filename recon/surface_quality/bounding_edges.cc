#include "recon/surface_quality/bounding_edges.h"

#include <tbb/parallel_for.h>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

BoundingEdges::BoundingEdges(const VisualHull& hull) {
  for (const auto& silhouette : hull.silhouettes())
    contour_edges_.push_back(silhouette->labels().contour().edges.size());
}

SurfaceValues ValuesOf(const VisualHull& hull, const HullView& picture, const ViewRays& rays,
                       const ValueAt& value) {
  core::Require(picture.surface.size() == picture.depth_mm.size() &&
                    picture.normal_in_world.size() == picture.depth_mm.size(),
                "a picture with the hull's surfaces and normals");
  core::Require(picture.width_px == rays.width_px() && picture.height_px == rays.height_px(),
                "the rays that the picture was made with");
  const BoundingEdges edges(hull);
  const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
  SurfaceValues values(picture.depth_mm.size());
  tbb::parallel_for(picture.hits.y, picture.hits.bottom, [&](int y) {
    for (int x = picture.hits.x; x < picture.hits.right; ++x) {
      const auto at = static_cast<std::size_t>(y * picture.width_px + x);
      const std::optional<core::CameraIndex> bounding = edges.CameraOf(picture.surface[at]);
      if (!bounding) continue;
      const Eigen::Vector3d x_in_world =
          world_from_view * PlaceInView(rays, x, y, static_cast<double>(picture.depth_mm[at]));
      values[at] = value(*bounding, x_in_world, picture.normal_in_world[at].cast<double>());
    }
  });
  return values;
}

}  // namespace elbowroom::recon
