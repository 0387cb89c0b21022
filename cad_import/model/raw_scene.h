// What the readers of the formats give: triangle soup in the file's own unit, where it stands, and what the
// file says of its unit.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "cad_import/model/file_unit.h"
#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

struct RawShape {
  std::string name;
  core::TriangleMesh mesh;  // in the file's unit until it is scaled, in spite of `vertices_mm`
  double deviation = 0.0;   // in the same unit, of the triangles from the surface that the file describes
};

struct RawInstance {
  std::string path;
  std::size_t shape = 0;
  Eigen::Affine3d model_from_shape = Eigen::Affine3d::Identity();
  std::optional<ColorRgb> color;
};

struct RawScene {
  std::vector<RawShape> shapes;
  std::vector<RawInstance> instances;
  std::optional<FileUnit> unit;                 // nothing: the file doesn't say
  bool are_mm = false;                          // its lengths are in mm already, converted from `unit`
  bool are_bodies = false;                      // each shape is one body, even if its mesh falls into pieces
  std::int64_t left_out = 0;                    // lines, points, bodies without a face
  std::vector<std::string> warnings;            // one line each
  std::vector<std::filesystem::path> referred;  // other files that were opened
};

// A file with more is refused: an instance may take only a few bytes of a file.
inline constexpr std::size_t kMostInstances = 1'000'000;

// The triangles of all instances.
[[nodiscard]] inline std::int64_t PlacedTriangles(const RawScene& scene) {
  std::int64_t count = 0;
  for (const RawInstance& instance : scene.instances)
    count += static_cast<std::int64_t>(scene.shapes[instance.shape].mesh.triangles.size());
  return count;
}

}  // namespace elbowroom::cad_import
