// The squares of a picture that something needs: the others are skipped. For the .cc files of this folder.
#pragma once

#include <cstddef>
#include <vector>

#include "recon/appearance/scene_view.h"
#include "recon/exact_view/hull_view.h"
#include "recon/gl/objects/texture.h"

namespace elbowroom::recon::gl {

inline constexpr int kSquarePx = 16;

// Draws triangles in clip space, at the far plane; attribute 0 has two floats.
extern const char* const kSquareVertexSource;

// A square as two triangles for kSquareVertexSource; (x_px, y_px) is its upper left pixel.
void AppendSquare(int x_px, int y_px, int width_px, int height_px, std::vector<float>& corners);

struct HitSquares {
  std::vector<float> corners;  // as AppendSquare has them
  std::size_t count = 0;
  TexelBox texels;  // of the layer: all that the squares' pixels show, and one more on each side; empty: none
};

// Those that hold the picture of the layer's hits and of the texels around them. The layer covers the view's
// picture, with any number of texels.
[[nodiscard]] HitSquares SquaresOfHits(const HullView& layer, const SceneView& view);

}  // namespace elbowroom::recon::gl
