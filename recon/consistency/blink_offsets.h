// Time offsets of cameras that run freely, from a light that blinks irregularly in view of all of them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "recon/consistency/blink_edges.h"

namespace elbowroom::recon {

struct BlinkOffsetOptions {
  // By camera, in s; 0 or missing: unknown, and found along with the offsets.
  std::vector<double> exposure_s = {};
  double search_s = 0.2;           // offsets of two cameras differ by less; > 0
  double shortest_blink_s = 0.04;  // the light stays on, and off, for at least this; > 0
  double stamp_jitter_s = 1e-4;    // of each stamp by itself, standard deviation; > 0
  double wrong_share = 0.01;       // of the edges that aren't what they seem; (0, 1)
  int draws = 20000;               // of the posterior; >= 1000
  std::uint64_t seed = 1;

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

struct BlinkOffsets {
  // A picture of camera i with the stamp t shows the scene at t + offset_s[i], on the clock of camera 0,
  // whose offset is 0.
  std::vector<double> offset_s;
  std::vector<double> sigma_s;     // standard uncertainty; 0 for camera 0
  Eigen::MatrixXd covariance_s2;   // of cameras 1, 2, ...
  std::vector<double> exposure_s;  // known or found
  std::size_t edges = 0;           // that two cameras or more saw
  std::size_t shares = 0;          // partly lit pictures among what they saw
};

// The posterior's mean and covariance, of the offsets and the unknown exposures, each edge's instant
// integrated out: a partly lit picture tells it to a small share of the exposure, and pictures that show no
// change bound it (docs/consistency.md; blink_offsets_test counts how often the uncertainty holds). The
// posterior is drawn from by an adaptive Metropolis walk (Haario et al. 2001), because bounds make it
// anything but normal. The same seed gives the same draws. Nothing: a curve doesn't blink or isn't linear, or
// fewer than 10 edges of each camera are seen by another. Throws: PreconditionError for fewer than two
// curves, or as FindBlinkEdges.
[[nodiscard]] std::optional<BlinkOffsets> FindBlinkOffsets(std::span<const BlinkCurve> curves,
                                                           const BlinkOffsetOptions& options = {});

}  // namespace elbowroom::recon
