// A depth map as a picture for people.
#pragma once

#include <Eigen/Core>
#include <span>

#include "recon/exact_view/view_rays.h"
#include "recon/images/depth_map.h"
#include "recon/images/image.h"

namespace elbowroom::recon {

// The surface in one colour, lit from over the viewer's left shoulder, before a plain background.
// `normal_in_world`: unit, one a pixel, zero where unknown. If it is empty, normals follow from the depths,
// smoothed over a few pixels; the planes of a sweep then show as contour lines. `rays`: those of the depths,
// of either projection. Throws: PreconditionError when the sizes differ.
[[nodiscard]] Image ShadeDepth(const ViewRays& rays, const DepthMap& picture,
                               std::span<const Eigen::Vector3f> normal_in_world);

}  // namespace elbowroom::recon
