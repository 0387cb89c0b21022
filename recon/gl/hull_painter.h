// Draws the hull's layer into the picture's depth. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "recon/gl/scene.h"
#include "recon/gl/shader_program.h"
#include "recon/gl/texture.h"
#include "recon/gl/vertex_array.h"
#include "recon/gl/view_matrices.h"

namespace elbowroom::recon::gl {

// Parts and hull hide each other pixel by pixel. In a picture with several samples a pixel the hull's rim is
// smoothed by a 3 x 3 quadratic B-spline over the layer's hits.
class HullPainter {
 public:
  HullPainter();

  void Draw(const HullLayer& layer, const Eigen::Vector3f& color, const ViewMatrices& matrices);

  // The depth of the layer's nearest texel as it is.
  void DrawDepth(const HullLayer& layer, const ViewMatrices& matrices);

 private:
  void DrawWith(const ShaderProgram& program, const HullLayer& layer, const SceneView& view);

  ShaderProgram picture_program_;
  ShaderProgram depth_program_;
  FloatTexture depth_{1};
  FloatTexture normal_{3};
  VertexArray corners_{};
};

}  // namespace elbowroom::recon::gl
