#include "recon/gl/scene/picture_squares.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace elbowroom::recon::gl {
namespace {

constexpr double kRimTexels = 1.0;  // that the soft rim reaches beside a hit

int SquaresIn(int size_px) { return (size_px + kSquarePx - 1) / kSquarePx; }

// The square that holds a texel's edge, of a side of the picture.
int SquareAt(double texel, int texels, int size_px) {
  const int px = static_cast<int>(std::floor(texel * size_px / texels));
  return std::clamp(px / kSquarePx, 0, SquaresIn(size_px) - 1);
}

// The texels [begin, end) of a side that the squares [first, last] show, and one more on each side.
std::pair<int, int> TexelsOf(int first, int last, int texels, int size_px) {
  const double per_px = static_cast<double>(texels) / size_px;
  const auto begin = static_cast<int>(std::floor(first * kSquarePx * per_px - 1.0));
  const auto end = static_cast<int>(std::ceil((last + 1) * kSquarePx * per_px + 1.0));
  return {std::max(begin, 0), std::min(end, texels)};
}

}  // namespace

const char* const kSquareVertexSource = R"(
layout(location = 0) in vec2 corner;
void main() { gl_Position = vec4(corner, 1.0, 1.0); }
)";

void AppendSquare(int x_px, int y_px, int width_px, int height_px, std::vector<float>& corners) {
  const auto clip = [](int px, int size_px) {
    return 2.0F * static_cast<float>(std::min(px, size_px)) / static_cast<float>(size_px) - 1.0F;
  };
  const float left = clip(x_px, width_px), right = clip(x_px + kSquarePx, width_px),
              low = clip(y_px, height_px), high = clip(y_px + kSquarePx, height_px);
  corners.insert(corners.end(), {left, low, right, low, right, high, left, low, right, high, left, high});
}

HitSquares SquaresOfHits(const HullView& layer, const SceneView& view) {
  const int across = SquaresIn(view.width_px), down = SquaresIn(view.height_px);
  std::vector<char> is_met(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  const float* row = layer.depth_mm.data();
  const auto is_hit = [](float depth_mm) { return depth_mm > 0.0F; };
  for (int y = 0; y < layer.height_px; ++y, row += layer.width_px) {
    const int top = SquareAt(y - kRimTexels, layer.height_px, view.height_px),
              bottom = SquareAt(y + 1 + kRimTexels, layer.height_px, view.height_px);
    for (const float* begin = std::find_if(row, row + layer.width_px, is_hit);
         begin != row + layer.width_px;) {
      const float* end = std::find_if_not(begin, row + layer.width_px, is_hit);
      const int left = SquareAt(static_cast<double>(begin - row) - kRimTexels, layer.width_px, view.width_px);
      const int right = SquareAt(static_cast<double>(end - row) + kRimTexels, layer.width_px, view.width_px);
      for (int i = top; i <= bottom; ++i) {
        const auto squares = is_met.begin() + std::ptrdiff_t{i} * across;
        std::fill(squares + left, squares + right + 1, char{1});
      }
      begin = std::find_if(end, row + layer.width_px, is_hit);
    }
  }
  HitSquares met;
  int x0 = across, x1 = -1, y0 = down, y1 = -1;
  for (int y = 0; y < down; ++y) {
    for (int x = 0; x < across; ++x) {
      if (is_met[static_cast<std::size_t>(y * across + x)] == 0) continue;
      AppendSquare(x * kSquarePx, y * kSquarePx, view.width_px, view.height_px, met.corners);
      ++met.count;
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = y;
    }
  }
  if (met.count == 0) return met;
  std::tie(met.texels.x, met.texels.right) = TexelsOf(x0, x1, layer.width_px, view.width_px);
  std::tie(met.texels.y, met.texels.bottom) = TexelsOf(y0, y1, layer.height_px, view.height_px);
  return met;
}

}  // namespace elbowroom::recon::gl
