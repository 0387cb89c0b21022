// How far one picture's surface is from another's.
#pragma once

#include <cstdint>
#include <vector>

#include "recon/images/depth_map.h"
#include "tests/accuracy/surface_picture.h"

namespace elbowroom::accuracy {

// Lengths in mm. Along the view ray: where both pictures have a surface, positive where the found one stands
// nearer to the viewer. To the surface: from each found point to the nearest of the reference, unsigned.
struct DepthError {
  std::int64_t compared = 0;   // pixels with a surface in both
  double missing_share = 0.0;  // of the reference's pixels: without one in the found picture
  double extra_share = 0.0;    // of the reference's pixels, as many only the found picture has
  double mean_mm = 0.0;        // along the ray
  double mean_abs_mm = 0.0;
  double rms_mm = 0.0;
  double largest_mm = 0.0;
  double surface_mean_mm = 0.0;  // to the surface
  double surface_rms_mm = 0.0;
  double surface_p95_mm = 0.0;
};

// Gathers what pictures of one scene (several draws of a random error) have against the reference.
class ErrorTally {
 public:
  // Compares every `stride`-th pixel in both directions. Found points farther than SurfacePicture::kReachPx
  // from all of the reference don't count to the surface. Throws: PreconditionError when sizes differ.
  void Add(const SurfacePicture& reference, const recon::DepthMap& found, int stride = 1);

  [[nodiscard]] DepthError Summary() const;

 private:
  std::int64_t reference_pixels_ = 0;
  std::int64_t missing_ = 0;
  std::int64_t extra_ = 0;
  std::vector<double> along_mm_;
  std::vector<double> to_surface_mm_;
};

// What one picture has against the reference.
[[nodiscard]] DepthError ErrorAgainst(const SurfacePicture& reference, const recon::DepthMap& found);

}  // namespace elbowroom::accuracy
