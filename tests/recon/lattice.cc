#include "tests/recon/lattice.h"

#include <cmath>
#include <cstddef>

namespace elbowroom::recon {

Lattice::Lattice(const core::SoftMask& silhouette, bool exterior_is_object)
    : mask_(silhouette.mask),
      exterior_(exterior_is_object),
      width_(mask_.width_px()),
      height_(mask_.height_px()),
      levels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), -1) {
  if (!silhouette.levels.empty()) {
    const core::BitMask boundary = core::BoundaryPixels(mask_);
    std::size_t next = 0;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        if (boundary.At(x, y)) levels_[static_cast<std::size_t>(y * width_ + x)] = silhouette.levels[next++];
  }
}

bool Lattice::IsObject(int x, int y) const { return IsInside(x, y) ? mask_.At(x, y) : exterior_; }

double Lattice::CrossingShare(int x, int y, int dx, int dy) const {
  if (!IsInside(x, y) || !IsInside(x + dx, y + dy)) return 0.5;
  const int a = levels_[static_cast<std::size_t>(y * width_ + x)];
  const int b = levels_[static_cast<std::size_t>((y + dy) * width_ + x + dx)];
  return a < 0 ? 0.5 : (a - 127.5) / (a - b);
}

// Whether a position is on the corner's side of the segment that cuts the corner (x, y) off its cell; `along`
// counts from the corner into the cell.
bool Lattice::CornerIsWithin(int x, int y, int dx, int dy, double along_x, double along_y) const {
  return along_x / CrossingShare(x, y, dx, 0) + along_y / CrossingShare(x, y, 0, dy) < 1.0;
}

bool Lattice::At(const Eigen::Vector2d& pixel) const {
  if (!(pixel.x() > -1.0 && pixel.y() > -1.0 && pixel.x() < width_ && pixel.y() < height_)) return exterior_;
  const int x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
  const double s = pixel.x() - x, t = pixel.y() - y;
  const bool a = IsObject(x, y), b = IsObject(x + 1, y), c = IsObject(x, y + 1), d = IsObject(x + 1, y + 1);
  const int objects = int{a} + int{b} + int{c} + int{d};
  if (objects == 0 || objects == 4) return a;
  if (objects == 2 && a != d) {  // one side against the other: a line across
    const bool is_beside = a == c;
    const double from = is_beside ? CrossingShare(x, y, 1, 0) : CrossingShare(x, y, 0, 1);
    const double to = is_beside ? CrossingShare(x, y + 1, 1, 0) : CrossingShare(x + 1, y, 0, 1);
    const double along = is_beside ? t : s, across = is_beside ? s : t;
    return (across < from + along * (to - from)) == a;
  }
  // Corners of the rarer label, of the background where they are two, are cut off.
  const bool cut = objects == 1;
  if (a == cut && CornerIsWithin(x, y, 1, 1, s, t)) return cut;
  if (b == cut && CornerIsWithin(x + 1, y, -1, 1, 1.0 - s, t)) return cut;
  if (c == cut && CornerIsWithin(x, y + 1, 1, -1, s, 1.0 - t)) return cut;
  if (d == cut && CornerIsWithin(x + 1, y + 1, -1, -1, 1.0 - s, 1.0 - t)) return cut;
  return !cut;
}

}  // namespace elbowroom::recon
