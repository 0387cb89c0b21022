// Whether pictures of an empty scene show one: nothing moves, and the light is steady.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recon/footage/frame_set.h"
#include "recon/light/light_report.h"

namespace elbowroom::recon {

struct TimedPicture {
  cv::Mat image_bgr;    // CV_8UC3
  double time_s = 0.0;  // of the middle of the exposure
};

struct EmptySceneReport {
  double mean_level = 0.0;           // grey levels, over all pixels and channels
  double sigma_median_levels = 0.0;  // of one pixel and channel over the pictures
  std::vector<cv::Rect> moved_px;    // where something moved, the largest first; empty: nothing did
  // Nothing also where there are too few pictures (kLeastGains), or something moved.
  std::optional<LightPulse> pulse;
  double least_gain = 1.0, most_gain = 1.0;  // of the light, against its mean; each a mean of five pictures

  // The light pulses or wanders by more than 2 % to either side, so that a threshold may feel it.
  [[nodiscard]] bool is_light_steady() const;
};

// What moved: pixels that differ from the mean of the pictures, once the change of light of the whole picture
// is taken off, by five times the noise of their level, by 8 levels, and by what a camera that shakes by 0.8
// pixels does at an edge; in a region of at least `min_blob_px` in one picture (a pixel at its edge may be
// missing). Things narrower than three pixels aren't seen, nor is what lies still all the time. The noise is
// that of the quietest quarter of the pixels of a level, so up to three quarters of a picture may move.
// `pictures`: at least two, in order of time, of one size. `reference`: measured from them. Throws:
// PreconditionError otherwise. Checked by tests/recon/light/empty_scene_test.cc.
[[nodiscard]] EmptySceneReport ExamineEmptyScene(std::span<const TimedPicture> pictures,
                                                 const BackgroundReference& reference, int min_blob_px);

// What keeps the pictures from being a background, a sentence each, with the camera's name and the place;
// empty: nothing does.
[[nodiscard]] std::vector<std::string> FaultsOf(const EmptySceneReport& report, const std::string& camera,
                                                const cv::Size& picture);

}  // namespace elbowroom::recon
