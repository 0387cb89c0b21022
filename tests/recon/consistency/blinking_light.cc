#include "tests/recon/consistency/blinking_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include "tests/recon/consistency/capsule_masks.h"

namespace elbowroom::recon::testing {

BlinkingLight::BlinkingLight(std::uint64_t seed, double until_s) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> duration_s(0.04, 0.16);
  for (double time_s = -1.0; time_s < until_s; time_s += duration_s(random)) changes_s_.push_back(time_s);
}

double BlinkingLight::LitShare(double from_s, double to_s) const {
  double lit_s = 0.0;
  auto at = std::ranges::upper_bound(changes_s_, from_s);
  bool is_on = (at - changes_s_.begin()) % 2 == 1;
  for (double now_s = from_s; now_s < to_s; is_on = !is_on) {
    const double next_s = at == changes_s_.end() ? to_s : std::min(*at++, to_s);
    if (is_on) lit_s += next_s - now_s;
    now_s = next_s;
  }
  return lit_s / (to_s - from_s);
}

BlinkPictures TakeBlinkPictures(const BlinkCamera& camera, double seconds) {
  BlinkPictures pictures;
  std::mt19937_64 random(camera.seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < seconds * camera.rate_hz; ++i) {
    const double stamp_s = camera.phase_s + i / camera.rate_hz;
    const double jitter_s = camera.jitter_s * normal(random);
    if (uniform(random) < camera.dropped_share) continue;
    pictures.stamp_s.push_back(stamp_s);
    pictures.true_s.push_back(stamp_s + camera.offset_s + jitter_s);
  }
  return pictures;
}

BlinkCurve CurveOf(const BlinkingLight& light, const BlinkCamera& camera, double seconds,
                   double noise_share) {
  constexpr double kDark = 900.0, kLight = 4000.0;
  const BlinkPictures pictures = TakeBlinkPictures(camera, seconds);
  BlinkCurve curve;
  curve.stamp_s = pictures.stamp_s;
  for (std::size_t i = 0; i < pictures.true_s.size(); ++i) {
    const double half_s = 0.5 * camera.exposure_s;
    const double lit = light.LitShare(pictures.true_s[i] - half_s, pictures.true_s[i] + half_s);
    const double noise = noise_share * NormalFrom(camera.seed + 17, i);
    curve.brightness.push_back(std::round(kDark + kLight * (lit + noise)));
  }
  return curve;
}

cv::Mat BlinkPicture(const BlinkingLight& light, const BlinkScene& scene, double true_s, double exposure_s,
                     std::uint64_t seed) {
  constexpr int kWidthPx = 96, kHeightPx = 64;
  cv::Mat picture(kHeightPx, kWidthPx, CV_8UC1);
  const double hand_x_px = 48.0 + 40.0 * std::sin(2.1 * true_s), hand_y_px = 48.0;
  for (int y = 0; y < kHeightPx; ++y) {
    const double middle_s = true_s + y * scene.row_delay_s;
    const double lit = light.LitShare(middle_s - 0.5 * exposure_s, middle_s + 0.5 * exposure_s);
    for (int x = 0; x < kWidthPx; ++x) {
      double level = 40.0 + 12.0 * std::sin(0.7 * x + 0.2 * y);
      if (std::hypot(x - hand_x_px, y - hand_y_px) < 9.0) level = 150.0;
      const double away2 = std::pow(x - scene.spot_x_px, 2) + std::pow(y - scene.spot_y_px, 2);
      level += lit * scene.peak_levels * std::exp(-0.5 * away2 / (scene.spot_sigma_px * scene.spot_sigma_px));
      level += scene.noise_levels * NormalFrom(seed, static_cast<std::uint64_t>(y * kWidthPx + x));
      picture.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
    }
  }
  return picture;
}

}  // namespace elbowroom::recon::testing
