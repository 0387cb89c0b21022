// A flat panel of triangles, for curtains and walls.
#pragma once

#include <Eigen/Core>

#include "core/triangle_mesh.h"

namespace elbowroom::test_support {

// A parallelogram with a corner at `corner_mm`, in across x down cells of two triangles each that turn about
// across_mm x down_mm; vertices row by row, `across_mm` first.
[[nodiscard]] core::TriangleMesh PanelMesh(int across, int down, const Eigen::Vector3d& corner_mm,
                                           const Eigen::Vector3d& across_mm, const Eigen::Vector3d& down_mm);

}  // namespace elbowroom::test_support
