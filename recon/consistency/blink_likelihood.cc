#include "recon/consistency/blink_likelihood.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace elbowroom::recon {
namespace {

// The instant is before or after a bound that is itself uncertain.
struct SoftBound {
  double at_s, sigma_s, sign;  // sign +1: the instant is later
};

// P(x) of a normal number; exact enough where it matters, and free far away.
double NormalBelow(double x) {
  constexpr double kFar = 6.0;
  if (x > kFar) return 1.0;
  if (x < -kFar) return 0.0;
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

// What all cameras say of one instant.
struct InstantEvidence {
  std::vector<SoftBound> bounds;
  // The product of what partly lit pictures say: a normal density about `middle_s`, with its factor.
  double weight = 0.0, weighted_s = 0.0, log_factor = 0.0;

  void AddInstant(double at_s, double sigma_s, double log_density_factor) {
    // The product of two normal densities is one, times a normal density of their distance.
    const double w = 1.0 / (sigma_s * sigma_s);
    if (weight > 0.0) {
      const double apart_s = at_s - weighted_s / weight;
      const double variance = sigma_s * sigma_s + 1.0 / weight;
      log_factor += -0.5 * (apart_s * apart_s / variance + std::log(2.0 * std::numbers::pi * variance));
    }
    log_factor += log_density_factor;
    weight += w, weighted_s += w * at_s;
  }

  // The integral over the instant.
  [[nodiscard]] double Integral() const { return weight > 0.0 ? AroundMiddle() : BetweenBounds(); }

 private:
  // Exact for one bound. Several are so far apart that at most one of them matters.
  [[nodiscard]] double AroundMiddle() const {
    const double variance = 1.0 / weight, middle_s = weighted_s / weight;
    double product = std::exp(log_factor);
    for (const SoftBound& bound : bounds)
      product *= NormalBelow(bound.sign * (middle_s - bound.at_s) /
                             std::sqrt(variance + bound.sigma_s * bound.sigma_s));
    return product;
  }

  // The latest of the lower bounds and the earliest of the upper ones matter: the mean of their distance,
  // where it is positive, with both uncertain.
  [[nodiscard]] double BetweenBounds() const {
    SoftBound from{-1e9, 0.0, 1.0}, to{1e9, 0.0, -1.0};
    for (const SoftBound& bound : bounds) {
      if (bound.sign > 0.0 ? bound.at_s > from.at_s : bound.at_s < to.at_s)
        (bound.sign > 0.0 ? from : to) = bound;
    }
    const double sigma_s = std::hypot(from.sigma_s, to.sigma_s), in_sigmas = (to.at_s - from.at_s) / sigma_s;
    const double density = std::exp(-0.5 * in_sigmas * in_sigmas) / std::sqrt(2.0 * std::numbers::pi);
    return sigma_s * (in_sigmas * NormalBelow(in_sigmas) + density);
  }
};

void AddSeen(const SharedEdge::Seen& seen, const BlinkNoise& noise, const BlinkTiming& timing, double blur_s,
             InstantEvidence* evidence) {
  const auto camera = static_cast<Eigen::Index>(seen.camera);
  const double offset_s = timing.offset_s[camera], exposure_s = timing.exposure_s[camera];
  const double share_sigma = noise.share_sigma[seen.camera];
  const BlinkEdge& edge = seen.edge;
  const double more_s = std::hypot(noise.stamp_jitter_s, blur_s);
  if (edge.share) {
    const double side = edge.is_on ? -1.0 : 1.0;
    const double at_s = edge.stamp_s + offset_s + side * (*edge.share - 0.5) * exposure_s;
    // The density of a share is that of the instant, times the exposure.
    evidence->AddInstant(at_s, std::hypot(share_sigma * exposure_s, more_s), std::log(exposure_s));
    return;
  }
  // A picture shows no change if its share is within 4 sigmas of dark or lit (FindBlinkEdges).
  const double sigma_s = std::hypot(share_sigma * exposure_s, more_s);
  const double inwards_s = (0.5 - kUnnoticedSigmas * share_sigma) * exposure_s;
  evidence->bounds.push_back({edge.after_s + offset_s + inwards_s, sigma_s, 1.0});
  evidence->bounds.push_back({edge.before_s + offset_s - inwards_s, sigma_s, -1.0});
}

}  // namespace

double LogLikelihood(std::span<const SharedEdge> edges, const BlinkNoise& noise, const BlinkTiming& timing,
                     double blur_s) {
  // What a wrong edge has instead: an even density over a share, and over some hundredths of a second.
  constexpr double kWrongIntegral = 1e-3;
  double sum = 0.0;
  for (const SharedEdge& edge : edges) {
    InstantEvidence evidence;
    for (const SharedEdge::Seen& seen : edge.seen) AddSeen(seen, noise, timing, blur_s, &evidence);
    sum += std::log((1.0 - noise.wrong_share) * evidence.Integral() + noise.wrong_share * kWrongIntegral);
  }
  return sum;
}

}  // namespace elbowroom::recon
