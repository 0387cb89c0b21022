// The bytes of small mesh files, made by hand so that what is tested doesn't write its own input.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::cad_import::testing {

[[nodiscard]] std::string StlText(const core::TriangleMesh& mesh, const std::string& name = "part");
[[nodiscard]] std::string StlBinary(const core::TriangleMesh& mesh);
[[nodiscard]] std::string ObjText(const core::TriangleMesh& mesh);
[[nodiscard]] std::string PlyText(const core::TriangleMesh& mesh);
[[nodiscard]] std::string PlyBinary(const core::TriangleMesh& mesh, bool big_endian = false);

// A glTF document of one mesh and the given nodes (JSON objects), all of them roots unless a `children` names
// them; its one buffer is `uri`, or the GLB's own where that is empty. Numbers of `mesh` stand as they are.
struct GltfSample {
  std::string json;
  std::string buffer;
};
[[nodiscard]] GltfSample Gltf(const core::TriangleMesh& mesh, const std::vector<std::string>& nodes,
                              const std::vector<int>& roots, const std::string& uri);
[[nodiscard]] std::string Glb(const GltfSample& sample);

}  // namespace elbowroom::cad_import::testing
