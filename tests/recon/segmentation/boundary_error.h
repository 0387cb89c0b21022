// How far a located silhouette lies from the true one of analytic solids.
#pragma once

#include <cstddef>
#include <span>

#include "core/camera_model.h"
#include "core/soft_mask.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

struct BoundaryError {
  double rms_px = 0.0;
  double bias_px = 0.0;  // mean; outwards is positive
  double worst_px = 0.0;
  std::size_t crossings = 0;
  std::size_t unmatched = 0;  // without a true boundary within two pixels: not part of the figures above
};

// Over all neighbours with different labels: where the boundary crosses the line between their centres,
// against where rays along that line begin to miss the solids; the difference across the boundary.
[[nodiscard]] BoundaryError ErrorOfBoundary(const core::SoftMask& located, const core::CameraModel& camera,
                                            std::span<const Solid> solids);

// The figures of all together.
[[nodiscard]] BoundaryError Pooled(std::span<const BoundaryError> errors);

}  // namespace elbowroom::recon
