// Watches the light and the background of one camera while pictures are taken.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "core/bit_mask.h"
#include "recon/footage/frame_set.h"
#include "recon/light/gain_history.h"
#include "recon/light/lasting_changes.h"
#include "recon/light/light_report.h"
#include "recon/segmentation/exposure_estimator.h"

namespace elbowroom::recon {

// Says how the light differs from that of the background reference now, whether it drifts or pulses, and
// where the background itself has changed. A picture costs less than 0.2 ms, a report some milliseconds
// (docs/light.md). Hours of hands at work under a slowly changing light give no advice that isn't true
// (tests/recon/light/light_watch_test.cc). Memory doesn't grow. Thread: one at a time.
class LightWatch {
 public:
  // `ignore`: pixels that aren't looked at, as for Segmenter. `is_followed`: the segmentation is kAdaptive.
  // Throws: PreconditionError for a background without mean or sigma, or an `ignore` of another size.
  LightWatch(std::string camera, const BackgroundReference& background, bool is_followed,
             const core::BitMask& ignore = {});

  // A picture, its mask, and when it was taken on any clock that runs evenly. A picture that isn't later than
  // the last one is left out. Throws: PreconditionError unless CV_8UC3, and both of the background's size.
  void Add(const cv::Mat& image_bgr, const core::BitMask& mask, double time_s);

  // All as of the last picture.
  [[nodiscard]] LightReport Report() const;

 private:
  std::string camera_;
  cv::Size size_;
  bool is_followed_;
  cv::Scalar mean_level_;
  ExposureEstimator estimator_;
  LastingChanges changes_;
  GainHistory gains_;
  ExposureChange exposure_;
  double agreeing_share_ = 1.0;  // averaged over seconds
  std::optional<double> time_s_, looked_s_;
};

}  // namespace elbowroom::recon
