// Which threshold gives a wanted share of false detections, from the noise of a background reference.
#pragma once

#include <optional>

#include "core/bit_mask.h"
#include "recon/footage/frame_set.h"

namespace elbowroom::recon {

struct NoiseThreshold {
  double k_sigma = 0.0;       // as in SegmentationOptions
  double floor_levels = 0.0;  // k_sigma times the typical noise, so that a pixel whose noise was measured too
                              // low by chance isn't trusted
  double false_positive_rate = 0.0;  // predicted: of a background pixel in a frame
};

// The thresholds with which a background pixel of a frame is a candidate with the wanted probability: before
// shade, small regions and ignored pixels are taken out. Noise is taken as Gaussian before it is rounded to
// whole levels, and as a function of a pixel's level and channel. That the reference's own mean and noise
// come from few frames is allowed for. The rate is within a factor of two of the wanted one
// (tests/recon/segmentation/noise_threshold_test.cc), or below it where no threshold gives it, as levels are
// whole numbers. Nothing: the reference has one frame only, or all of it is clipped. `edge_slack_px`: as in
// SegmentationOptions. Throws: core::Error{kRange} unless the wanted rate is in 1e-9..0.1; PreconditionError
// for a background without mean or sigma, or for an `ignore` of another size (no size: none is ignored).
[[nodiscard]] std::optional<NoiseThreshold> SuggestThreshold(const BackgroundReference& background,
                                                             double wanted_rate, double edge_slack_px,
                                                             const core::BitMask& ignore = {});

// The standard deviation of Gaussian noise whose rounded levels have this variance, averaged over all places
// of the true level between two whole ones. Inverts sigma^2 + 1/12 - sum exp(-(2 pi k sigma)^2) / (2 pi^2
// k^2) over k = 1, 2, ...
[[nodiscard]] double SigmaBeforeRounding(double rounded_variance);

}  // namespace elbowroom::recon
