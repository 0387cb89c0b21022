// Coarser surfaces of a mesh, for drawing only. Contacts and clearances are judged by the whole mesh.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/triangle_mesh.h"
#include "recon/gl/scene/surface_mesh.h"

namespace elbowroom::recon::gl {

// Meshes of fewer triangles are drawn whole.
inline constexpr std::size_t kTrianglesWorthLevels = 20'000;

struct DetailLevel {
  std::vector<float> corners;  // as SurfaceMesh's
  std::int64_t triangles = 0;
  double error_mm = 0.0;  // the farthest that any vertex of the whole mesh is from this surface
};

// Each level has about half of the triangles of the one before, by quadric error metrics (Garland and
// Heckbert 1997) as in meshoptimizer. A level's vertices are the mesh's own and are shaded by the whole
// mesh's normals (`whole`, of PrepareSurface), so that coarse curves stay smooth. Ends when few triangles are
// left, when hardly any more come off, or between two levels when `stop` is asked. The errors are measured
// (core::FindNearest): the metric's own error is a single-precision average.
// `mesh`: valid by core::ValidateMesh. Thread: any.
[[nodiscard]] std::vector<DetailLevel> MakeDetailLevels(const core::TriangleMesh& mesh,
                                                        const SurfaceMesh& whole,
                                                        const std::stop_token& stop = {});

}  // namespace elbowroom::recon::gl
