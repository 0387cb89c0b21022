// What a CAD file holds, in millimetres: bodies, each stored once, and where they stand.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

// A named piece of a mesh: consecutive triangles.
struct ImportedPart {
  std::string name;
  std::int64_t first_triangle = 0;
  std::int64_t triangles = 0;

  [[nodiscard]] bool operator==(const ImportedPart&) const = default;
};

// What was found in a body's surface, and what was done to it.
struct SurfaceReport {
  bool watertight = false;
  std::int64_t dropped_flat = 0;
  std::int64_t kept_flat = 0;  // without area, but a closed surface hangs together by them
  std::int64_t dropped_duplicates = 0;
  std::int64_t turned = 0;              // triangles whose corners were put into the other order
  std::int64_t open_edges = 0;          // of one triangle
  std::int64_t non_manifold_edges = 0;  // of three or more
  std::int64_t inconsistent_edges = 0;  // of two triangles that run along it the same way
  std::optional<std::int64_t> self_intersections = 0;  // pairs of triangles; nothing: not looked for

  [[nodiscard]] bool operator==(const SurfaceReport&) const = default;
};

// A body in its own frame.
struct CadShape {
  std::string name;
  core::SharedMesh mesh;
  std::vector<ImportedPart> pieces;  // cover all triangles, in order; ModelOf's shape has none
  SurfaceReport surface;
};

using ColorRgb = std::array<float, 3>;  // 0..1, sRGB

struct CadInstance {
  std::string path;  // names from the root down, with '/' between
  std::size_t shape = 0;
  core::RigidTransform model_from_shape;
  std::optional<ColorRgb> color;
};

struct ImportReport {
  std::int64_t parts = 0;       // pieces of all instances
  std::int64_t triangles = 0;   // of all instances
  std::string unit;             // that the file's numbers were read in: "mm", "in", "ft", "0.1 m"
  bool is_unit_stated = false;  // by the file itself, whether or not it was read in that one
  Eigen::AlignedBox3d bounds_mm;
  bool watertight = false;  // every body is
  bool repaired = false;    // triangles were dropped or turned
  std::int64_t dropped_triangles = 0;
  double deviation_mm = 0.0;          // the largest of any shape's mesh
  std::vector<std::string> warnings;  // one line each
};

struct CadModel {
  std::vector<CadShape> shapes;
  std::vector<CadInstance> instances;
  ImportReport report;
};

// A model of one mesh in one place; its surface isn't looked at, and its shape has no pieces.
[[nodiscard]] CadModel ModelOf(core::SharedMesh mesh, const std::string& name);

// All instances as one mesh in the model's frame, the pieces of each in the order of the instances. A name
// that recurs gets a number.
struct FlatModel {
  core::SharedMesh mesh;
  std::vector<ImportedPart> parts;
};
// With a node, only those whose path is it or lies below it: "Box/Lid" takes "Box/Lid/Screw" along, but not
// "Box/Lid 2". Throws: PreconditionError for a node that isn't among NodesOf.
[[nodiscard]] FlatModel Flatten(const CadModel& model, std::string_view node = {});

// The paths of the instances and of all that they hang under, each once.
[[nodiscard]] std::vector<std::string> NodesOf(const CadModel& model);

}  // namespace elbowroom::cad_import
