// What a camera's pictures say of the light, and of the background that they are compared with.
#pragma once

#include <array>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>
#include <vector>

namespace elbowroom::recon {

// The light grows or falls steadily.
struct SlowDrift {
  double share_per_hour = 0.0;  // of the light now; positive: brighter
  double over_s = 0.0;          // the time that it was seen in
  double tenth_in_s = 0.0;      // it changes by a tenth in this time, if it goes on like this
};

// The light pulses. Lamps on mains of 50 Hz pulse at 100 Hz, on mains of 60 Hz at 120 Hz; pictures are too
// few to show that, and show it at a lower, aliased frequency.
struct LightPulse {
  double amplitude_share = 0.0;   // the light is within 1 +- this
  double seen_hz = 0.0;           // as the pictures show it, at most half of their rate
  std::optional<double> lamp_hz;  // of the lamps, near 100 or 120; nothing: both fit, or neither
  bool fits_lamps = false;        // one of both fits
  bool matters = false;           // it may move silhouettes under kThreshold
};

// The background is another one at a place, for long, and nothing moves there.
struct LastingChange {
  cv::Rect box_px;
  double share = 0.0;         // of the picture
  double object_share = 0.0;  // of its pixels: what the masks say is object
};

struct LightReport {
  std::string camera;
  double time_s = 0.0;                            // of the last picture
  double gain = 1.0;                              // light now / light of the reference
  std::array<double, 3> gain_bgr{1.0, 1.0, 1.0};  // a channel, at the background's mean level
  double agreeing_share = 1.0;                    // of the background's pixels that were looked at
  std::optional<SlowDrift> drift;
  std::optional<LightPulse> pulse;
  std::vector<int> hidden_mains_hz;  // 50, 60: lamps that the pictures' rate hides, or shows very slowly
  std::vector<LastingChange> changes;
  std::vector<std::string> advice;  // a sentence each, with the camera's name; empty: all is well
};

// Where in the picture: "upper left", "in the middle", "lower right" ...
[[nodiscard]] std::string PlaceInPicture(const cv::Rect& box_px, const cv::Size& picture);

// The sentences for a report that is complete but for them. `is_followed`: the segmentation follows the light
// (kAdaptive), so that a change of the whole picture needs no action.
[[nodiscard]] std::vector<std::string> AdviceFor(const LightReport& report, const cv::Size& picture,
                                                 bool is_followed);

}  // namespace elbowroom::recon
