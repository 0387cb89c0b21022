// Draws the virtual parts. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/gl/scene/level_maker.h"
#include "recon/gl/scene/part_detail.h"
#include "recon/gl/scene/scene.h"
#include "recon/gl/scene/view_matrices.h"

namespace elbowroom::recon::gl {

class Lighting;
enum class HullShadow;

// What a lamp saw of the parts.
struct CasterPass {
  Eigen::AlignedBox2f bounds;      // around all of them, in shares of the lamp's picture; empty: none
  std::int64_t parts_outside = 0;  // left out: not in the picture
};

// Keeps each mesh on the graphics card for as long as somebody else keeps the mesh.
class PartPainter {
 public:
  explicit PartPainter(PartDetail detail);

  // Uploads meshes that aren't on the graphics card yet, and drops those that nobody else keeps. Chooses the
  // level at which each part is drawn, in every pass until the next call. To be called before any drawing,
  // which may then be of these parts only.
  // Throws: Error{kGeometry} for a mesh that can't be drawn (see core::ValidateMesh).
  void Update(std::span<const ScenePart> parts, const SceneView& view);

  // Waits until all levels of the meshes that Update was given are there. Does nothing with
  // PartDetail::kWhole.
  void AwaitLevels();

  // Depths of the opaque parts, so that DrawOpaque shades only what is seen: the same picture.
  void DrawOpaqueDepth(std::span<const ScenePart> parts, const ViewMatrices& matrices);
  void DrawOpaque(std::span<const ScenePart> parts, const ViewMatrices& matrices, const Lighting& light,
                  HullShadow hull_shadow);

  // Back to front. What is drawn later and stands behind a part is hidden.
  void DrawTransparent(std::span<const ScenePart> parts, const ViewMatrices& matrices, const Lighting& light);

  // Draws depths only, as a lamp sees them, of every part that isn't invisible. What stands before the lamp's
  // near plane is drawn on that plane.
  [[nodiscard]] CasterPass DrawCasters(std::span<const ScenePart> parts, const ViewMatrices& lamp);

  // Draws the depths of faces only, of every part that isn't invisible.
  void DrawDepth(std::span<const ScenePart> parts, const ViewMatrices& matrices);

  // The least z of the part's box in world, of a mesh that Update was given.
  [[nodiscard]] double LowestMm(const ScenePart& part) const;

  // A box around the part in a view, in shares of the view's sides from its upper left; empty: outside. Where
  // some of the part's box is behind the eye, all of the picture. Of a mesh that Update was given.
  [[nodiscard]] Eigen::AlignedBox2f BoundsIn(const ScenePart& part, const SceneView& view) const;

  // The level of each part, in the order of the last Update; 0 is the whole mesh.
  [[nodiscard]] const std::vector<std::size_t>& levels() const { return levels_; }

  [[nodiscard]] std::size_t cached_meshes() const { return meshes_.size(); }
  [[nodiscard]] std::int64_t mesh_uploads() const { return mesh_uploads_; }
  [[nodiscard]] const TriangleCount& triangle_count() const { return triangle_count_; }

 private:
  struct UploadedSurface {
    VertexArray faces{3, 3};
    std::int64_t triangles = 0;
    double error_mm = 0.0;
  };
  struct UploadedMesh {
    std::vector<UploadedSurface> levels;  // the whole mesh, then coarser and coarser
    VertexArray edges{3};                 // of the whole mesh, whatever level its faces are of
    Eigen::AlignedBox3d bounds_in_part;
  };
  // The address is needed, too: shared pointers to different members of one object have one owner.
  struct MeshKey {
    std::weak_ptr<const core::TriangleMesh> owner;
    const core::TriangleMesh* address = nullptr;
    [[nodiscard]] bool operator<(const MeshKey& other) const;
  };

  [[nodiscard]] const UploadedMesh& Uploaded(const core::SharedMesh& mesh) const;
  [[nodiscard]] std::size_t LevelFor(const ScenePart& part, const SceneView& view) const;
  // A part and what of it is drawn.
  struct DrawnPart {
    const ScenePart& part;
    const UploadedSurface& surface;
    const VertexArray& edges;
    std::int64_t left_out = 0;  // triangles
  };
  [[nodiscard]] DrawnPart Drawn(std::span<const ScenePart> parts, std::size_t i) const;
  static void AddLevel(std::vector<UploadedSurface>& levels, const DetailLevel& level);
  void UploadLevels(const MadeLevels& made);
  void DrawFaces(const DrawnPart& drawn, const ViewMatrices& matrices);
  void DrawFaceDepth(const DrawnPart& drawn, const ViewMatrices& matrices);
  void DrawTriangles(const DrawnPart& drawn);
  void DrawEdges(const DrawnPart& drawn, const ViewMatrices& matrices, float alpha);

  ShaderProgram face_program_;
  ShaderProgram edge_program_;
  ShaderProgram depth_program_;
  std::map<MeshKey, UploadedMesh> meshes_;
  std::vector<std::size_t> levels_;
  std::optional<LevelMaker> level_maker_;
  std::int64_t mesh_uploads_ = 0;
  TriangleCount triangle_count_;
};

}  // namespace elbowroom::recon::gl
