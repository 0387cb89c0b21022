// Where float32 can't decide what a ray of the exact view meets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recon/exact_view/view_pencils.h"

namespace elbowroom::recon {

// Whoever walks a ray over the pencils in float32, in whatever order of operations, finds the same hit or
// miss, and depths that differ by less than kViewTolerance of themselves, unless the pixel is in the band:
// the ray passes a turn of a contour, or two surfaces at once, within the rounding of angles and keys.
// Derived in docs/exact_view_gl.md; exact_view_gl_test holds two implementations to it.
inline constexpr double kViewTolerance = 1e-5;

// Borrows the pencils. Thread: any.
class ViewBand {
 public:
  explicit ViewBand(const ViewPencils& pencils) : pencils_(pencils) {}

  [[nodiscard]] bool Contains(int x, int y) const;

 private:
  const ViewPencils& pencils_;
};

}  // namespace elbowroom::recon
