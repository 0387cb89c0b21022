// Which way the hull's surface faces where a view meets it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "recon/hull_view.h"

namespace elbowroom::recon {

// One a pixel, unit, out of the hull; zero where the ray misses. That of the contour's edge
// (OutwardNormalInCam), or of the workspace's face.
[[nodiscard]] std::vector<Eigen::Vector3f> NormalsOf(const VisualHull& hull, const ViewRays& rays,
                                                     const HullView& view);

}  // namespace elbowroom::recon
