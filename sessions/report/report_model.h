// What the 3-D view of a report shows.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/layout.h"
#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"
#include "sessions/report/report_touch.h"

namespace elbowroom::sessions {

struct ReportModel {
  // One of the trial's frames.
  struct Moment {
    core::FrameIndex frame = 0;
    std::vector<core::RigidTransform> world_from_parts;  // in the layout's order
    core::TriangleMesh hull;                             // world, mm
    std::vector<Eigen::Vector3d> contacts_in_world_mm;
  };
  std::vector<Moment> moments;  // the first is shown first; none: the report has no 3-D view
  // What CAD must leave free, in world, mm.
  std::optional<core::TriangleMesh> keep_out = {};
};

// Meshes of more triangles are told coarser.
inline constexpr std::size_t kMostModelTriangles = 20'000;
inline constexpr std::size_t kMostVolumeTriangles = 100'000;  // of the keep-out volume, which is one

// What web/page/model_view.js takes, as JSON in ASCII without "<": {meshes, parts, volumes, moments, low,
// high}.
[[nodiscard]] std::string ModelJson(const core::Layout& layout, const Eigen::AlignedBox3d& workspace_mm,
                                    const ReportModel& model);

// {low, step, vertices, triangles, wide}: corners rounded to steps of a grid over the mesh's box, both lists
// in base64, little-endian. The box has 65535 steps a side; if more than `most_triangles` are left, 1023,
// 511, ...
// 15. Triangles of which two corners fall together are left out. Rounding error: half a step on each axis.
[[nodiscard]] std::string PackedMeshJson(const core::TriangleMesh& mesh, std::size_t most_triangles);

}  // namespace elbowroom::sessions
