#include "tests/accuracy/depth_error.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "tests/accuracy/quantile.h"

namespace elbowroom::accuracy {
namespace {

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double RootMeanSquare(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

void ErrorTally::Add(const SurfacePicture& reference, const recon::DepthMap& found, int stride) {
  core::Require(
      found.width_px == reference.depth().width_px && found.height_px == reference.depth().height_px,
      "pictures that are compared have one size");
  for (int y = 0; y < found.height_px; y += stride) {
    for (int x = 0; x < found.width_px; x += stride) {
      const double expected_mm = reference.DepthAt(x, y);
      const double found_mm =
          found.depth_mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(found.width_px) +
                         static_cast<std::size_t>(x)];
      reference_pixels_ += expected_mm > 0.0 ? 1 : 0;
      missing_ += expected_mm > 0.0 && found_mm <= 0.0 ? 1 : 0;
      if (found_mm <= 0.0) continue;
      const Eigen::Vector3d point = reference.PointAt(x, y, found_mm);
      if (const auto distance_mm = reference.DistanceMm(point, x, y)) to_surface_mm_.push_back(*distance_mm);
      if (expected_mm <= 0.0) {
        ++extra_;
        continue;
      }
      const double along = (reference.PointAt(x, y, 1.0) - reference.view().center_in_world()).norm();
      along_mm_.push_back((expected_mm - found_mm) * along);
    }
  }
}

DepthError ErrorTally::Summary() const {
  DepthError error;
  error.compared = static_cast<std::int64_t>(along_mm_.size());
  const double pixels = static_cast<double>(std::max<std::int64_t>(reference_pixels_, 1));
  error.missing_share = static_cast<double>(missing_) / pixels;
  error.extra_share = static_cast<double>(extra_) / pixels;
  std::vector<double> absolute_mm = along_mm_;
  for (double& value : absolute_mm) value = std::abs(value);
  error.mean_mm = Mean(along_mm_);
  error.mean_abs_mm = Mean(absolute_mm);
  error.rms_mm = RootMeanSquare(along_mm_);
  error.largest_mm = Quantile(absolute_mm, 1.0);
  error.surface_mean_mm = Mean(to_surface_mm_);
  error.surface_rms_mm = RootMeanSquare(to_surface_mm_);
  error.surface_p95_mm = Quantile(to_surface_mm_, 0.95);
  return error;
}

DepthError ErrorAgainst(const SurfacePicture& reference, const recon::DepthMap& found) {
  ErrorTally tally;
  tally.Add(reference, found);
  return tally.Summary();
}

}  // namespace elbowroom::accuracy
