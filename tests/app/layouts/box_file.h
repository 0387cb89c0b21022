// Boxes and round walls, and CAD files of them.
#pragma once

#include <Eigen/Core>
#include <cmath>
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

// The wall of a cylinder along z, from `from_rad` around by `around_rad`.
inline core::TriangleMesh Wall(double radius_mm, double length_mm, double around_rad, int facets,
                               bool is_hole) {
  core::TriangleMesh mesh;
  for (int i = 0; i <= facets; ++i) {
    const double angle = around_rad * i / facets;
    for (const double z : {0.0, length_mm})
      mesh.vertices_mm.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle), z);
  }
  for (int i = 0; i < facets; ++i) {
    const int a = 2 * i, b = a + 1, c = a + 2, d = a + 3;
    if (is_hole) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({c, b, d});
    } else {
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({c, d, b});
    }
  }
  return mesh;
}

// .stl, .ply (which carry no unit) or .glb (which does).
inline std::filesystem::path WriteBox(const std::filesystem::path& file, const Eigen::Vector3d& size_mm) {
  std::filesystem::create_directories(file.parent_path());
  cad_import::WriteMeshFile(BoxMesh(size_mm), file);
  return file;
}

}  // namespace elbowroom::test_support
