// Draws the hull's layer into the picture's depth. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/texture.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/gl/scene/lighting.h"
#include "recon/gl/scene/picture_squares.h"
#include "recon/gl/scene/scene.h"
#include "recon/gl/scene/view_matrices.h"

namespace elbowroom::recon::gl {

// Parts and hull hide each other pixel by pixel. Squares of the picture without a hit are skipped. In a
// picture with several samples a pixel the hull's rim is smoothed by a 3 x 3 quadratic B-spline over the
// layer's hits.
class HullPainter {
 public:
  HullPainter();

  // The layer's camera colours show where the appearance asks for them.
  void Draw(const Scene& scene, const ViewMatrices& matrices, const Lighting& light);

  // Draws the depth of the layer's nearest texel, without smoothing.
  void DrawDepth(const HullView& layer, const ViewMatrices& matrices);

 private:
  void UploadSurface(const Scene& scene, const TexelBox& texels);
  void DrawWith(const ShaderProgram& program, const HullView& layer, const SceneView& view,
                const HitSquares& squares);

  ShaderProgram texel_program_;
  ShaderProgram spline_program_;
  ShaderProgram depth_program_;
  FloatTexture depth_{1};
  FloatTexture normal_{3};
  ColorTexture camera_color_;
  VertexArray corners_{2};
};

}  // namespace elbowroom::recon::gl
