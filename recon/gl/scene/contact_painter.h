// Marks contact points. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <Eigen/Core>
#include <span>

#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/gl/scene/view_matrices.h"

namespace elbowroom::recon::gl {

// Round red marks of constant size in pixels. A point that stands behind something is marked faintly; 12 mm
// behind a surface still counts as on it, since contacts lie under the hull's skin.
class ContactPainter {
 public:
  ContactPainter();

  // To be called last of all.
  void Draw(std::span<const Eigen::Vector3d> points_in_world, const ViewMatrices& matrices);

 private:
  ShaderProgram program_;
  VertexArray marks_{3, 2};
};

}  // namespace elbowroom::recon::gl
