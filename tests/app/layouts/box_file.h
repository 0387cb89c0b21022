// Boxes as CAD files.
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "cad_import/mesh_file.h"
#include "core/triangle_mesh.h"

namespace elbowroom::test_support {

// From the origin to size_mm.
inline core::TriangleMesh BoxMesh(const Eigen::Vector3d& size_mm) {
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.push_back(size_mm.cwiseProduct(Eigen::Vector3d(i & 1, (i >> 1) & 1, (i >> 2) & 1)));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// .stl, .ply (which carry no unit) or .glb (which does).
inline std::filesystem::path WriteBox(const std::filesystem::path& file, const Eigen::Vector3d& size_mm) {
  std::filesystem::create_directories(file.parent_path());
  cad_import::WriteMeshFile(BoxMesh(size_mm), file);
  return file;
}

}  // namespace elbowroom::test_support
