// Draws what stands around the parts: background, table, workspace and cameras. For the .cc files of this
// folder: it includes OpenGL.
#pragma once

#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/gl/scene/lighting.h"
#include "recon/gl/scene/scene.h"
#include "recon/gl/scene/view_matrices.h"

namespace elbowroom::recon::gl {

class SurroundingsPainter {
 public:
  SurroundingsPainter();

  // Covers the whole picture; leaves the depth as it is.
  void DrawBackground(const Scene& scene) const;

  // The grid on z = 0 with the shadows on it, faint when it is seen from below. To be called after all that
  // is opaque.
  void DrawTable(const Scene& scene, const ViewMatrices& matrices, const Lighting& light,
                 HullShadow hull_shadow) const;

  // The workspace's edges and the cameras' pyramids.
  void DrawLines(const Scene& scene, const ViewMatrices& matrices);

 private:
  ShaderProgram background_program_;
  ShaderProgram table_program_;
  ShaderProgram line_program_;
  VertexArray no_vertices_{};
  VertexArray lines_{3, 4};
};

}  // namespace elbowroom::recon::gl
