// Places where the background has become another one.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/bit_mask.h"
#include "recon/footage/frame_set.h"
#include "recon/light/light_report.h"
#include "recon/segmentation/exposure.h"

namespace elbowroom::recon {

// Looks at one pixel in each square of a grid. Each votes over time for the colour that it mostly shows (the
// majority vote of Boyer and Moore, weighted by time), under the light of the reference. A square has changed
// when its majority has another colour than the background, and it shows that colour nearly always. Changed
// squares that adjoin each other are a lasting change where hardly anything moves around them: around a hand
// that rests, something does.
class LastingChanges {
 public:
  // From here on a change counts: of a thing that nobody touches for so long, or of a hand in a cramp.
  static constexpr double kLastingS = 120.0;
  static constexpr int kSquarePx = 8;
  static constexpr std::size_t kLeastSquares = 6;

  // Throws: PreconditionError for a background without mean or sigma, or an `ignore` of another size.
  LastingChanges(const BackgroundReference& background, const core::BitMask& ignore);

  // A picture of the background's size, its mask, the change of light that it shows, and the time since the
  // last one (taken as at most one second).
  void Add(const cv::Mat& image_bgr, const core::BitMask& mask, const ExposureChange& exposure,
           double passed_s);

  [[nodiscard]] std::vector<LastingChange> Changes() const;

 private:
  struct Square {
    cv::Point place;
    std::array<float, 3> background{}, tolerance{};
    std::array<float, 3> majority{};  // under the light of the reference
    float weight_s = 0.0F;            // how sure the majority is
    float restless = 0.0F;            // share of the last time in which it showed another colour
    float object = 0.0F;              // likewise: in which the mask said object
    bool is_ignored = false;
  };

  [[nodiscard]] static bool IsOther(const Square& square);     // its majority has another colour
  [[nodiscard]] static bool HasChanged(const Square& square);  // for good
  [[nodiscard]] static bool IsQuietBackground(const Square& square);
  [[nodiscard]] std::vector<std::size_t> Around(std::size_t square) const;

  cv::Size size_;
  int across_ = 0, down_ = 0;
  std::vector<Square> squares_;
};

}  // namespace elbowroom::recon
