// From the triangle soup that files hold to one indexed mesh whose surface can be judged.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

// One body as a file gave it, any soup of triangles, already in millimetres and in the file's own frame.
struct RawPart {
  std::string name;
  core::TriangleMesh mesh;
};

// Where a body of the file is in the flattened mesh: consecutive triangles.
struct ImportedPart {
  std::string name;
  std::int64_t first_triangle = 0;
  std::int64_t triangles = 0;
};

struct CleanMesh {
  core::TriangleMesh mesh;
  std::vector<ImportedPart> parts;
  bool watertight = false;
  bool repaired = false;               // dropped or turned something; welding alone is no repair
  std::int64_t dropped_triangles = 0;  // without area
  std::vector<std::string> warnings;
};

// Welds equal vertices (noise around zero aside) within each part; parts that are still open are welded with
// each other as well, since exporters cut one surface up by material or group. A file of a single part is
// listed by its connected pieces. Drops triangles without area, except those of three different points that a
// closed surface hangs together by. Turns closed surfaces that face inwards. Throws: Error{kGeometry} naming
// `where`: a vertex that is not finite, no triangle left.
[[nodiscard]] CleanMesh CleanParts(std::vector<RawPart> parts, const std::string& where);

}  // namespace elbowroom::cad_import
