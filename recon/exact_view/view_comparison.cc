#include "recon/exact_view/view_comparison.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/error.h"
#include "recon/exact_view/view_band.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

// One pixel's part.
void AddPixel(float a_mm, float b_mm, bool is_in_band, ViewComparison* sum) {
  ++sum->pixels;
  sum->hit_pixels += a_mm != 0.0F ? 1 : 0;
  sum->band_pixels += is_in_band ? 1 : 0;
  const bool both_hit = a_mm != 0.0F && b_mm != 0.0F;
  const double difference_mm = std::abs(static_cast<double>(a_mm) - static_cast<double>(b_mm));
  const double relative = both_hit ? difference_mm / std::abs(static_cast<double>(a_mm)) : 0.0;
  const bool differ = both_hit ? !(relative <= kViewTolerance) : a_mm != b_mm;
  if (is_in_band) {
    sum->differing_in_band += differ ? 1 : 0;
    return;
  }
  sum->differing_pixels += differ ? 1 : 0;
  if (!both_hit) return;
  sum->largest_difference_mm = std::max(sum->largest_difference_mm, difference_mm);
  sum->largest_relative_difference = std::max(sum->largest_relative_difference, relative);
}

ViewComparison Sum(ViewComparison a, const ViewComparison& b) {
  a.pixels += b.pixels;
  a.hit_pixels += b.hit_pixels;
  a.band_pixels += b.band_pixels;
  a.differing_in_band += b.differing_in_band;
  a.differing_pixels += b.differing_pixels;
  a.largest_difference_mm = std::max(a.largest_difference_mm, b.largest_difference_mm);
  a.largest_relative_difference = std::max(a.largest_relative_difference, b.largest_relative_difference);
  return a;
}

}  // namespace

ViewComparison CompareViews(const VisualHull& hull, const ViewRays& rays, const HullView& a,
                            const HullView& b) {
  const auto pixels = static_cast<std::size_t>(rays.width_px()) * static_cast<std::size_t>(rays.height_px());
  core::Require(a.depth_mm.size() == pixels && b.depth_mm.size() == pixels,
                "views to compare have the rays' size");
  std::optional<ViewPencils> pencils;
  if (!hull.IsEmpty()) pencils.emplace(hull, rays);
  // Pixels outside of all squares are settled in float64, so they aren't in the band.
  std::vector<std::uint8_t> is_open(pixels, 0);
  const auto width = static_cast<std::size_t>(rays.width_px());
  for (const PixelBox& square : pencils ? pencils->Squares() : std::vector<PixelBox>()) {
    for (int y = square.y; y < square.bottom; ++y) {
      std::uint8_t* row = is_open.data() + width * static_cast<std::size_t>(y);
      std::fill(row + square.x, row + square.right, std::uint8_t{1});
    }
  }
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, rays.height_px()), ViewComparison(),
      [&](const tbb::blocked_range<int>& rows, ViewComparison sum) {
        for (int y = rows.begin(); y < rows.end(); ++y) {
          for (int x = 0; x < rays.width_px(); ++x) {
            const std::size_t pixel = width * static_cast<std::size_t>(y) + static_cast<std::size_t>(x);
            const bool is_in_band = is_open[pixel] != 0 && ViewBand(*pencils).Contains(x, y);
            AddPixel(a.depth_mm[pixel], b.depth_mm[pixel], is_in_band, &sum);
          }
        }
        return sum;
      },
      Sum);
}

}  // namespace elbowroom::recon
