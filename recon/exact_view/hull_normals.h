// Which way the hull's surface faces where a view meets it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/rigid_transform.h"
#include "recon/exact_view/hull_view.h"

namespace elbowroom::recon {

// Normals of a hull's surface for the pixels of a view; both must outlive it. Thread: any.
class HullNormals {
 public:
  // Computes the normals of all contours' edges, in parallel.
  HullNormals(const VisualHull& hull, const ViewRays& rays);

  // Unit, out of the hull: that of the contour's edge (OutwardNormalInCam), or of the face (of the workspace,
  // of a half-space), at pixel (x, y), whose ray meets the surface.
  [[nodiscard]] Eigen::Vector3f Of(const HullSurface& surface, int x, int y, float depth_mm) const;

 private:
  const VisualHull& hull_;
  const ViewRays& rays_;
  core::RigidTransform world_from_view_;
  std::vector<std::vector<Eigen::Vector3f>> edge_normals_;  // by camera
};

// The normals of a whole view with surfaces: one a pixel, zero where the ray misses.
[[nodiscard]] PictureBuffer<Eigen::Vector3f> NormalsOf(const VisualHull& hull, const ViewRays& rays,
                                                       const HullView& view);

}  // namespace elbowroom::recon
