// A light that blinks at random, as simulated cameras see it.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "recon/consistency/blink_edges.h"

namespace elbowroom::recon::testing {

// On and off for 40 to 160 ms in turn, by the seed.
class BlinkingLight {
 public:
  BlinkingLight(std::uint64_t seed, double until_s);

  // The share of the time from `from_s` to `to_s` in which it is on.
  [[nodiscard]] double LitShare(double from_s, double to_s) const;

 private:
  std::vector<double> changes_s_;  // on, off, on ...
};

struct BlinkCamera {
  std::uint64_t seed = 1;
  double offset_s = 0.0;  // a picture with the stamp t has the middle of its exposure at t + offset_s
  double exposure_s = 0.008;
  double rate_hz = 30.0;
  double phase_s = 0.0;    // stamp of the first picture
  double jitter_s = 5e-5;  // of each stamp, standard deviation
  double dropped_share = 0.01;
};

// Which pictures the camera kept, and when they were really taken: the middle of each exposure.
struct BlinkPictures {
  std::vector<double> stamp_s, true_s;
};
[[nodiscard]] BlinkPictures TakeBlinkPictures(const BlinkCamera& camera, double seconds);

// The brightness of each picture, with noise as a share of the light's.
[[nodiscard]] BlinkCurve CurveOf(const BlinkingLight& light, const BlinkCamera& camera, double seconds,
                                 double noise_share);

// A picture of 96 x 64: the light's spot with its halo, saturated in the middle, before a textured
// background; a hand of skin's colour that passes by, and noise. Rows are exposed one after the other.
struct BlinkScene {
  double spot_x_px = 40.0, spot_y_px = 22.0;
  double peak_levels = 600.0;  // of the light alone, before it is cut at 255
  double spot_sigma_px = 2.0;
  double noise_levels = 3.0;
  double row_delay_s = 0.0;  // from a row to the next; the stamp is that of row 0
};
[[nodiscard]] cv::Mat BlinkPicture(const BlinkingLight& light, const BlinkScene& scene, double true_s,
                                   double exposure_s, std::uint64_t seed);

}  // namespace elbowroom::recon::testing
