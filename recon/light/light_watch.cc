#include "recon/light/light_watch.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr int kWatchSamples = 1024;  // the gain is then known to a three-hundredth
constexpr double kLookEveryS = 0.2;  // for lasting changes, which take minutes
constexpr double kAgreeingS = 10.0;  // over which the agreeing share is averaged

// The gain at the background's mean level: gain and offset by themselves are badly known on a background of
// one level.
double GainAt(const ExposureChange& exposure, std::size_t channel, double level) {
  return exposure.gain[channel] + exposure.offset_levels[channel] / std::max(level, 1.0);
}

}  // namespace

LightWatch::LightWatch(std::string camera, const BackgroundReference& background, bool is_followed,
                       const core::BitMask& ignore)
    : camera_(std::move(camera)),
      size_(background.mean_bgr.size()),
      is_followed_(is_followed),
      estimator_(background, ignore, kWatchSamples),
      changes_(background, ignore) {
  mean_level_ = cv::mean(background.mean_bgr);
}

void LightWatch::Add(const cv::Mat& image_bgr, const core::BitMask& mask, double time_s) {
  core::Require(image_bgr.type() == CV_8UC3 && image_bgr.size() == size_ && mask.width_px() == size_.width &&
                    mask.height_px() == size_.height,
                "a picture to watch is 8-bit BGR, and it and its mask are of its background's size");
  if (time_s_ && !(time_s > *time_s_)) return;
  exposure_ = estimator_.Estimate(image_bgr);
  double gain = 0.0;
  for (std::size_t c = 0; c < 3; ++c) gain += GainAt(exposure_, c, mean_level_[static_cast<int>(c)]) / 3.0;
  gains_.Add({time_s, gain});
  const double passed_s = time_s_ ? time_s - *time_s_ : 0.0;
  agreeing_share_ += (1.0 - std::exp(-passed_s / kAgreeingS)) * (exposure_.agreeing_share - agreeing_share_);
  time_s_ = time_s;
  if (looked_s_ && time_s - *looked_s_ < kLookEveryS) return;
  changes_.Add(image_bgr, mask, exposure_, looked_s_ ? time_s - *looked_s_ : 0.0);
  looked_s_ = time_s;
}

LightReport LightWatch::Report() const {
  LightReport report;
  report.camera = camera_;
  if (!time_s_) return report;
  report.time_s = *time_s_;
  report.gain = gains_.Now();
  for (std::size_t c = 0; c < 3; ++c)
    report.gain_bgr[c] = GainAt(exposure_, c, mean_level_[static_cast<int>(c)]);
  report.agreeing_share = agreeing_share_;
  report.drift = gains_.Drift();
  report.pulse = gains_.Pulse();
  if (gains_.RateHz() > 0.0) report.hidden_mains_hz = HiddenMainsHz(gains_.RateHz());
  report.changes = changes_.Changes();
  report.advice = AdviceFor(report, size_, is_followed_);
  return report;
}

}  // namespace elbowroom::recon
