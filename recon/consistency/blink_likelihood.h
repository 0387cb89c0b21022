// How likely offsets and exposures make what the cameras saw of a light's changes.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "recon/consistency/blink_matching.h"

namespace elbowroom::recon {

struct BlinkNoise {
  std::vector<double> share_sigma;  // by camera
  double stamp_jitter_s = 1e-4;
  double wrong_share = 0.01;
};

// Offsets and exposures of all cameras, in s.
struct BlinkTiming {
  Eigen::VectorXd offset_s, exposure_s;
};

// The logarithm, but for a constant, each edge's instant integrated out. `blur_s` is added to all
// uncertainties, for a search from afar.
[[nodiscard]] double LogLikelihood(std::span<const SharedEdge> edges, const BlinkNoise& noise,
                                   const BlinkTiming& timing, double blur_s);

}  // namespace elbowroom::recon
