// A mesh made ready to draw: normals that keep its edges crisp and its curves smooth.
#pragma once

#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::recon::gl {

struct SurfaceMesh {
  std::vector<float> corners;        // three a triangle: x y z (part frame, mm), nx ny nz (unit)
  std::vector<float> feature_edges;  // two ends an edge: x y z (part frame, mm)
};

// A corner's normal averages the triangles around its vertex that turn from its own by less than crease_rad,
// weighted by their angle there. A feature edge turns by more, or bounds other than two triangles. Vertices
// at one place are one vertex, so that STL's loose triangles join; triangles without area are left out.
[[nodiscard]] SurfaceMesh PrepareSurface(const core::TriangleMesh& mesh, double crease_rad);

}  // namespace elbowroom::recon::gl
