// The faces of a solid as triangles, and how far those are from them.
#pragma once

#include "core/triangle_mesh.h"

class TopoDS_Shape;

namespace elbowroom::cad_import {

struct Tessellation {
  core::TriangleMesh
      mesh;  // in the shape's own frame and unit; the vertices of an edge are shared by its faces
  double deviation = 0.0;  // the largest distance found between a triangle and its face
  int faces = 0;
  int faces_without_triangles = 0;  // that could not be meshed
};

// Triangles by BRepMesh. It aims at a chordal tolerance but doesn't keep it everywhere: so the distance from
// the face is measured at the middle of each triangle and each of its edges, and the shape is meshed again,
// finer, up to three times while it exceeds `tolerance` (> 0). Thread: any; the shape must not be in use by
// another.
[[nodiscard]] Tessellation Tessellate(const TopoDS_Shape& shape, double tolerance);

// The diagonal of its bounding box; 0 for a shape without faces.
[[nodiscard]] double DiagonalOf(const TopoDS_Shape& shape);

}  // namespace elbowroom::cad_import
