// A part's mesh with its edges, ready to be drawn as an outline.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bvh.h"
#include "core/triangle_mesh.h"

namespace elbowroom::control {

// Corners and triangles are indices of the mesh.
struct MeshEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  std::uint32_t left = 0;
  std::uint32_t right = 0;
  // Drawn from everywhere: its faces are at an angle of more than kSharpEdgeDeg, or it hasn't two faces.
  bool is_sharp = false;
};

inline constexpr double kSharpEdgeDeg = 30.0;

// Immutable. Thread: any.
class OutlinedMesh {
 public:
  // Corners at one position count as one, so that a mesh whose faces share none has no seams. Edges between
  // faces of one plane are left out: they are never drawn. The mesh must have triangles.
  explicit OutlinedMesh(core::SharedMesh mesh);

  [[nodiscard]] const core::TriangleTree& tree() const { return tree_; }
  [[nodiscard]] const core::TriangleMesh& mesh() const { return tree_.mesh(); }
  [[nodiscard]] const std::vector<MeshEdge>& edges() const { return edges_; }

  // Those that are drawn as seen from a place in the part's frame: the sharp ones, and those between a face
  // that is seen from its outer side and one that is seen from its inner side.
  [[nodiscard]] std::vector<MeshEdge> EdgesSeenFrom(const Eigen::Vector3d& eye_in_part) const;

 private:
  core::TriangleTree tree_;
  std::vector<MeshEdge> edges_;
};

// Makes each mesh's outline once, and forgets those whose mesh nobody else has. Not for several threads.
class OutlinedMeshes {
 public:
  [[nodiscard]] std::shared_ptr<const OutlinedMesh> Of(const core::SharedMesh& mesh);

 private:
  std::vector<std::shared_ptr<const OutlinedMesh>> made_;
};

}  // namespace elbowroom::control
