// Where float32 can't decide what a ray of the exact view meets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recon/exact_view/view_pencils.h"

namespace elbowroom::recon {

// Two computations of the exact view in float32, with operations in whatever order, agree on hit or miss, and
// their depths differ by less than kViewTolerance of themselves, unless the pixel is in the band. A pixel is
// in it if its ray passes, within the rounding of angles and keys, a vertex where a contour's entries turn
// into exits, or two surfaces at once. Derived in docs/exact_view_gl.md; exact_view_gl_test holds two
// implementations to it.
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
