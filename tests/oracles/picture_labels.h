// What a mask says of any place in its picture, the slow and obvious way.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/soft_mask.h"

namespace elbowroom::oracles {

enum class BoundaryConvention {
  kPixelSquares,    // all of a pixel's square [x - 0.5, x + 0.5)^2 carries its bit
  kMarchingSquares  // straight segments between the crossings of a cell of four pixel centres
};

using Vector2L = Eigen::Matrix<long double, 2, 1>;
using Vector3L = Eigen::Matrix<long double, 3, 1>;

// Marching squares: pixels' values are their levels, 255 and 0 where there is none; the boundary crosses the
// line between two centres a (object) and b at (a - 127.5) / (a - b) of the way. In a saddle cell (object in
// two opposite corners) the object joins. The picture is surrounded by pixels of the exterior's label;
// against them the boundary is halfway, on the picture's border. Positions outside carry the exterior's
// label. Immutable. Thread: any.
class PictureLabels {
 public:
  PictureLabels(const core::SoftMask& mask, BoundaryConvention convention, bool exterior_is_object);

  // With every boundary moved by `grow_px`: outwards of the object if positive. |grow_px| <= 0.5.
  [[nodiscard]] bool IsObject(const Vector2L& position_px, double grow_px = 0.0) const;

  // Of a pixel, or the exterior's.
  [[nodiscard]] bool IsObjectPixel(int x, int y) const;

  // Share of the way from pixel a to its neighbour b, of the other label, at which the boundary is.
  [[nodiscard]] long double CrossingShare(int ax, int ay, int bx, int by) const;

 private:
  // A piece of the boundary in one cell; the object lies left of a to b.
  struct Segment {
    Vector2L a, b;
  };
  struct Cell {
    bool is_object = false;  // where there are no segments
    int segments = 0;
    std::array<Segment, 2> segment{};
  };

  [[nodiscard]] bool IsPixel(int x, int y) const {
    return x >= 0 && y >= 0 && x < width_px_ && y < height_px_;
  }
  [[nodiscard]] int ValueAt(int x, int y) const;  // the exterior's outside
  [[nodiscard]] bool IsInPicture(const Vector2L& position_px) const;
  [[nodiscard]] long double SquaresDistance(const Vector2L& position_px, bool label) const;
  [[nodiscard]] bool LabelAt(const Vector2L& position_px) const;
  [[nodiscard]] long double BoundaryDistance(const Vector2L& position_px) const;
  [[nodiscard]] Cell CellAt(int x, int y) const;

  int width_px_ = 0;
  int height_px_ = 0;
  BoundaryConvention convention_;
  bool exterior_is_object_;
  std::vector<std::uint8_t> values_;
};

// What a camera sees of such a picture, as object: all of it, less the corners' tips where boundaries run
// between pixel centres.
[[nodiscard]] PictureLabels OutlineLabels(int width_px, int height_px, BoundaryConvention convention);

}  // namespace elbowroom::oracles
