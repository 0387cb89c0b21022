#include "recon/consistency/blink_region.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr std::size_t kFewestPictures = 20;
constexpr int kChangeLevels = 30;       // from one picture to the next: a blink, not noise
constexpr double kShareOfBlinks = 0.1;  // of the pictures, in the pixel that blinks most
constexpr double kShareOfSeed = 0.3;    // of the changes of that pixel, in the others of the region
constexpr int kSaturatedLevel = 250;
constexpr int kFewestLinearPixels = 4;

cv::Mat Grey(const cv::Mat& picture) {
  core::Require(picture.type() == CV_8UC1 || picture.type() == CV_8UC3,
                "a picture has 8 bits and 1 or 3 channels");
  if (picture.channels() == 1) return picture;
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

// By pixel: the sum of all changes that are blinks, how many there are, and the highest and lowest level.
struct Changes {
  cv::Mat sum, count, highest, lowest;  // CV_32S, CV_32S, CV_8U, CV_8U
};

Changes ChangesOf(std::span<const cv::Mat> pictures) {
  cv::Mat last = Grey(pictures.front());
  Changes changes{cv::Mat::zeros(last.size(), CV_32S), cv::Mat::zeros(last.size(), CV_32S), last.clone(),
                  last.clone()};
  for (const cv::Mat& picture : pictures.subspan(1)) {
    const cv::Mat grey = Grey(picture);
    core::Require(grey.size() == last.size(), "all pictures have one size");
    cv::Mat difference;
    cv::absdiff(grey, last, difference);
    const cv::Mat is_blink = difference >= kChangeLevels;
    cv::add(changes.sum, difference, changes.sum, is_blink, CV_32S);
    cv::add(changes.count, cv::Scalar(1), changes.count, is_blink, CV_32S);
    cv::max(changes.highest, grey, changes.highest);
    cv::min(changes.lowest, grey, changes.lowest);
    last = grey.clone();
  }
  return changes;
}

}  // namespace

std::optional<BlinkRegion> FindBlinkingRegion(std::span<const cv::Mat> pictures) {
  core::Require(pictures.size() >= kFewestPictures, "a blinking light is looked for in 20 pictures or more");
  const Changes changes = ChangesOf(pictures);
  double most = 0.0;
  cv::Point seed;
  cv::minMaxLoc(changes.sum, nullptr, &most, nullptr, &seed);
  if (changes.count.at<std::int32_t>(seed) < kShareOfBlinks * static_cast<double>(pictures.size()))
    return std::nullopt;
  // Pixels that blink as often as the seed, joined to it; in the halo they blink less strongly.
  cv::Mat labels;
  cv::connectedComponents(changes.count >= kShareOfSeed * changes.count.at<std::int32_t>(seed), labels, 8,
                          CV_32S);
  const int label = labels.at<std::int32_t>(seed);
  BlinkRegion region;
  region.width_px = labels.cols, region.height_px = labels.rows;
  std::vector<int> all, linear;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      if (labels.at<std::int32_t>(y, x) != label) continue;
      all.push_back(y * labels.cols + x);
      if (changes.highest.at<std::uint8_t>(y, x) < kSaturatedLevel &&
          changes.lowest.at<std::uint8_t>(y, x) > 0)
        linear.push_back(all.back());
    }
  region.is_linear = static_cast<int>(linear.size()) >= kFewestLinearPixels;
  region.pixels = region.is_linear ? linear : all;
  for (const int pixel : region.pixels) {
    const int row = pixel / region.width_px;
    region.row_px += row / static_cast<double>(region.pixels.size());
  }
  return region;
}

double BrightnessIn(const cv::Mat& picture, const BlinkRegion& region) {
  core::Require(picture.cols == region.width_px && picture.rows == region.height_px,
                "a picture has the size of those that the region was found in");
  const cv::Mat grey = Grey(picture);
  double sum = 0.0;
  for (const int pixel : region.pixels)
    sum += grey.at<std::uint8_t>(pixel / region.width_px, pixel % region.width_px);
  return sum;
}

}  // namespace elbowroom::recon
