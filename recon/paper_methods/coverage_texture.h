// A silhouette as a texture: how much of each pixel is object.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/soft_mask.h"

namespace elbowroom::recon {

inline constexpr double kObjectLevel = 127.5;  // of 255: half of a pixel

// One byte a pixel, from 0 (background) to 255 (object); the levels between are along the boundary, where the
// mask has them. Cut to the object's rectangle and a pixel around it. A position inside `valid_px` (lower end
// included) is object where the bilinear interpolation of the four texels around it is at least
// kObjectLevel; any other position of the picture is background. The label's edges cross the lines between
// pixel centres where marching squares would. Beyond the picture's border, half a pixel outside its last
// centres, texels repeat the border's.
struct CoverageTexture {
  int left_px = 0, top_px = 0;              // picture position of the first texel
  int width_texels = 0, height_texels = 0;  // 0: nothing is object
  Eigen::AlignedBox2d valid_px;             // of no size: nothing is object
  std::vector<std::uint8_t> texels;         // row-major, and four bytes that may be read beyond the last
};

[[nodiscard]] CoverageTexture MakeCoverageTexture(const core::SoftMask& mask);

// The coverage at a position of the picture, 0 to 255.
[[nodiscard]] double CoverageAt(const CoverageTexture& texture, const Eigen::Vector2d& position_px);

// Which blocks of 8 x 8 pixels hold object, and which background. Sums over the blocks answer for any
// rectangle in constant time.
class BlockOccupancy {
 public:
  explicit BlockOccupancy(const core::BitMask& mask);

  // Pixels [x0, x1] x [y0, y1] of the picture, both ends included. False only if none of them is object.
  [[nodiscard]] bool MayHoldObject(int x0, int y0, int x1, int y1) const {
    return Count(object_, x0, y0, x1, y1) != 0;
  }
  // False only if none of them is background.
  [[nodiscard]] bool MayHoldBackground(int x0, int y0, int x1, int y1) const {
    return Count(background_, x0, y0, x1, y1) != 0;
  }

 private:
  [[nodiscard]] int Count(const std::vector<int>& sums, int x0, int y0, int x1, int y1) const {
    const int left = x0 >> 3, top = (y0 >> 3) * stride_, right = (x1 >> 3) + 1,
              bottom = ((y1 >> 3) + 1) * stride_;
    const auto at = [&](int i) { return sums[static_cast<std::size_t>(i)]; };
    return at(bottom + right) - at(bottom + left) - at(top + right) + at(top + left);
  }

  int stride_ = 0;
  std::vector<int> object_, background_;  // blocks above and left of a block's corner that hold any
};

}  // namespace elbowroom::recon
