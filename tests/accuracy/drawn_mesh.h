// A closed mesh seen by a camera, with a depth buffer.
#pragma once

#include "core/camera_model.h"
#include "core/triangle_mesh.h"
#include "recon/images/depth_map.h"

namespace elbowroom::accuracy {

// `view` has no distortion; triangles with a vertex at or behind its camera plane are left out. One thread.
[[nodiscard]] recon::DepthMap DrawMesh(const core::TriangleMesh& mesh_in_world,
                                       const core::CameraModel& view);

}  // namespace elbowroom::accuracy
