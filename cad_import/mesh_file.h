// Mesh files to core meshes in millimetres, and back.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cad_import/mesh_cleaning.h"
#include "core/triangle_mesh.h"
#include "core/units.h"

namespace elbowroom::cad_import {

struct ImportOptions {
  std::optional<core::LengthUnit> unit{};  // of the file's numbers; overrides what the file says
  std::optional<core::LengthUnit> unit_if_file_has_none{};  // for STL, OBJ and PLY when `unit` is not given
};

struct ImportReport {
  int parts = 0;  // nodes with triangles; connected pieces where the file has only one node
  std::int64_t triangles = 0;
  core::LengthUnit unit = core::LengthUnit::kMillimetre;  // that the file's numbers were read in
  Eigen::AlignedBox3d bounds_mm;
  bool watertight = false;
  bool repaired = false;  // triangles were dropped or turned
  std::int64_t dropped_triangles = 0;
  std::vector<std::string> warnings;  // one line each
};

struct ImportedMesh {
  core::TriangleMesh mesh;  // every node at its place, in the file's own frame and axes
  std::vector<ImportedPart> parts;
  ImportReport report;
};

// Reads STL (text and binary), OBJ, PLY, glTF and GLB. Vertices pass through single precision (6e-8 of their
// coordinates). Axes are the file's own: glTF's y stays y. Surfaces as in CleanParts.
// Throws: Error{kFile} (missing, unreadable), Error{kFormat} (another format, cut off, damaged), Error{kCad}
// (no unit known: names the size in each), Error{kGeometry} (no triangles, a vertex that is not finite).
[[nodiscard]] ImportedMesh ImportMeshFile(const std::filesystem::path& path,
                                          const ImportOptions& options = {});

// Writes .ply (binary little-endian, millimetres), .stl (binary, millimetres) or .glb (metres, as its
// specification demands) by the path's extension, whole or not at all; coordinates in single precision.
// Throws: Error{kGeometry} for a mesh that ValidateMesh refuses, Error{kFormat} for another extension,
// Error{kFile} if it can't be written.
void WriteMeshFile(const core::TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace elbowroom::cad_import
