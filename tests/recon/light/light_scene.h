// A drawn table with hands at work on it, for hours, fast to draw.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "core/bit_mask.h"
#include "recon/footage/frame_set.h"

namespace elbowroom::recon {

struct DrawnPicture {
  cv::Mat image_bgr;
  core::BitMask mask;  // hands and what lies there; a perfect segmentation
};

enum class TableGround { kDarkCloth, kGreyTable, kPatchwork };

// 320 x 240 pixels. Levels are a function of (ground, seed) and of what is asked for.
class LightScene {
 public:
  // `hover_s`: how long hands stay at a place, where they move within a few centimetres.
  LightScene(TableGround ground, double noise_levels, std::uint64_t seed, double hover_s = 60.0);

  // Frames of the empty scene under the reference's light.
  [[nodiscard]] BackgroundReference Background() const;

  // `gain`: the light. `hands`: two hands with forearms work: they go from place to place, move around each
  // for a while and tremble. `thing_px`: a thing of another colour that lies there; empty: none.
  [[nodiscard]] DrawnPicture At(double time_s, std::array<double, 3> gain_bgr, bool hands,
                                const cv::Rect& thing_px = {}) const;

 private:
  double noise_levels_;
  std::uint64_t seed_;
  double hover_s_;
  cv::Mat levels_;  // CV_32FC3
};

}  // namespace elbowroom::recon
