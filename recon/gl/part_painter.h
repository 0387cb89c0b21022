// Draws the virtual parts. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "recon/gl/scene.h"
#include "recon/gl/shader_program.h"
#include "recon/gl/vertex_array.h"
#include "recon/gl/view_matrices.h"

namespace elbowroom::recon::gl {

class Lighting;

// What a lamp saw of the parts.
struct CasterPass {
  Eigen::AlignedBox2f bounds;      // around all of them, in shares of the lamp's picture; empty: none
  std::int64_t parts_outside = 0;  // left out: nowhere in the picture
};

// Keeps each mesh on the graphics card for as long as somebody else keeps the mesh.
class PartPainter {
 public:
  PartPainter();

  // Brings what isn't there yet to the graphics card and drops what nobody else keeps; before any drawing.
  // Throws: Error{kGeometry} for a mesh that can't be drawn (see core::ValidateMesh).
  void Update(std::span<const ScenePart> parts);

  void DrawOpaque(std::span<const ScenePart> parts, const ViewMatrices& matrices, const Lighting& light);

  // Back to front. What is drawn later and stands behind a part is hidden.
  void DrawTransparent(std::span<const ScenePart> parts, const ViewMatrices& matrices, const Lighting& light);

  // Depths alone, as a lamp sees them, of every part that isn't invisible; what stands before its near plane
  // is drawn on it.
  [[nodiscard]] CasterPass DrawCasters(std::span<const ScenePart> parts, const ViewMatrices& lamp);

  // Faces alone, of every part that isn't invisible.
  void DrawDepth(std::span<const ScenePart> parts, const ViewMatrices& matrices);

  [[nodiscard]] std::size_t cached_meshes() const { return meshes_.size(); }
  [[nodiscard]] std::int64_t mesh_uploads() const { return mesh_uploads_; }

 private:
  struct UploadedMesh {
    VertexArray faces{3, 3};
    VertexArray edges{3};
    Eigen::AlignedBox3d bounds_in_part;
  };
  // The address too: shared pointers to different members of one object have one owner.
  struct MeshKey {
    std::weak_ptr<const core::TriangleMesh> owner;
    const core::TriangleMesh* address = nullptr;
    [[nodiscard]] bool operator<(const MeshKey& other) const;
  };

  [[nodiscard]] const UploadedMesh& Uploaded(const core::SharedMesh& mesh) const;
  void DrawFaces(const ScenePart& part, const ViewMatrices& matrices);
  void DrawFaceDepth(const ScenePart& part, const ViewMatrices& matrices);
  void DrawEdges(const ScenePart& part, const ViewMatrices& matrices, float alpha);

  ShaderProgram face_program_;
  ShaderProgram edge_program_;
  ShaderProgram depth_program_;
  std::map<MeshKey, UploadedMesh> meshes_;
  std::int64_t mesh_uploads_ = 0;
};

}  // namespace elbowroom::recon::gl
