// Compares two results for one exact view.
#pragma once

#include <cstdint>

#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

struct ViewComparison {
  std::int64_t pixels = 0;
  std::int64_t hit_pixels = 0;   // of the first view
  std::int64_t band_pixels = 0;  // where float32 can't decide (ViewBand)
  // Pixels that one view hits and the other misses, or whose depths differ by more than kViewTolerance of
  // themselves.
  std::int64_t differing_in_band = 0;
  std::int64_t differing_pixels = 0;  // outside of the band: 0 if the views agree
  // Over the pixels outside the band where both views have a depth.
  double largest_difference_mm = 0.0;
  double largest_relative_difference = 0.0;

  [[nodiscard]] bool Agree() const { return differing_pixels == 0; }
};

// Throws: PreconditionError when a view's size isn't the rays'.
[[nodiscard]] ViewComparison CompareViews(const VisualHull& hull, const ViewRays& rays, const HullView& a,
                                          const HullView& b);

}  // namespace elbowroom::recon
