#include "tests/oracles/exposure_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <opencv2/core.hpp>
#include <vector>

#include "core/error.h"

namespace elbowroom::oracles {
namespace {

constexpr int kLevels = 256;
constexpr double kLastLevel = 255.0;
// Levels near the ends of the range are clipped by the sensor and say nothing of the exposure.
constexpr int kDarkestLevel = 3;
constexpr int kBrightestLevel = 250;
// Counts of pixels by (background level, picture level), one channel.
using JointHistogram = std::vector<std::uint32_t>;

// One row of the joint histogram: the picture's median where the background has this level.
struct LevelPair {
  double background = 0.0;
  double picture = 0.0;
  double weight = 0.0;  // pixels
};

JointHistogram JointHistogramOf(const cv::Mat& image_bgr, const cv::Mat& mean_bgr, int channel) {
  constexpr int kPixelsEnough = 40'000;  // more make the estimate better than its use needs
  const int every = std::max(1, image_bgr.rows * image_bgr.cols / kPixelsEnough);
  JointHistogram joint(static_cast<std::size_t>(kLevels * kLevels), 0);
  for (int y = 0; y < image_bgr.rows; y += every) {
    const auto* image = image_bgr.ptr<std::uint8_t>(y);
    const auto* mean = mean_bgr.ptr<float>(y);
    for (int i = channel; i < image_bgr.cols * 3; i += 3) {
      const float half_more = mean[i] + 0.5F;  // positive: cut off, it is the nearest level
      ++joint[static_cast<std::size_t>(static_cast<int>(half_more) * kLevels + image[i])];
    }
  }
  return joint;
}

// Median with the levels spread evenly over their unit interval, so that it moves by less than a whole level.
LevelPair MedianOf(const JointHistogram& joint, int level) {
  const std::uint32_t* row = joint.data() + level * kLevels;
  double total = 0.0;
  for (int i = 0; i < kLevels; ++i) total += row[i];
  double below = 0.0;
  for (int i = 0; i < kLevels; ++i) {
    if (below + row[i] >= 0.5 * total && row[i] > 0) {
      return {static_cast<double>(level), i - 0.5 + (0.5 * total - below) / row[i], total};
    }
    below += row[i];
  }
  return {static_cast<double>(level), 0.0, 0.0};
}

struct Line {
  double gain = 1.0;
  double offset = 0.0;
};

// Weighted least squares; a gain alone where the levels spread too little to tell it from an offset.
Line Fit(const std::vector<LevelPair>& pairs, const Line& before) {
  constexpr double kLeastSpreadLevels = 8.0;
  double w = 0.0, b = 0.0, p = 0.0, bb = 0.0, bp = 0.0;
  for (const LevelPair& pair : pairs) {
    w += pair.weight;
    b += pair.weight * pair.background;
    p += pair.weight * pair.picture;
    bb += pair.weight * pair.background * pair.background;
    bp += pair.weight * pair.background * pair.picture;
  }
  if (!(w > 0.0) || !(bb > 0.0)) return before;
  const double variance = bb / w - (b / w) * (b / w);
  if (variance < kLeastSpreadLevels * kLeastSpreadLevels) return {p / b, 0.0};
  const double gain = (bp / w - (b / w) * (p / w)) / variance;
  return {gain, p / w - gain * b / w};
}

// A first line through the medians, refitted without the levels that it misses: there an object hides most of
// the background.
Line FitMedians(const std::vector<LevelPair>& pairs) {
  constexpr int kFits = 5;
  constexpr double kLeastMissLevels = 1.5;
  Line line = Fit(pairs, {});
  for (int round = 0; round < kFits && !pairs.empty(); ++round) {
    const auto miss = [&](const LevelPair& pair) {
      return std::abs(pair.picture - line.gain * pair.background - line.offset);
    };
    std::vector<double> misses;
    for (const LevelPair& pair : pairs) misses.push_back(miss(pair));
    const auto middle = misses.begin() + static_cast<std::ptrdiff_t>(misses.size() / 2);
    std::nth_element(misses.begin(), middle, misses.end());
    const double allowed = std::max(kLeastMissLevels, 2.5 * *middle);
    std::vector<LevelPair> kept;
    std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(kept),
                 [&](const LevelPair& pair) { return miss(pair) <= allowed; });
    line = Fit(kept, line);
  }
  return line;
}

// Refits to the pixels themselves, within fewer and fewer levels around the line, so that pixels of an object
// drop out.
Line Refined(const JointHistogram& joint, Line line) {
  for (const double window_levels : {24.0, 16.0, 11.0, 8.0, 8.0, 8.0}) {
    std::vector<LevelPair> near;
    for (int level = kDarkestLevel; level <= kBrightestLevel; ++level) {
      const double expected = line.gain * level + line.offset;
      // Windows that reach past the sensor's ends would hold only one side of the noise.
      if (expected - window_levels < kDarkestLevel || expected + window_levels > kBrightestLevel) continue;
      const int first = static_cast<int>(std::ceil(expected - window_levels));
      const int last = static_cast<int>(std::floor(expected + window_levels));
      LevelPair pair{static_cast<double>(level), 0.0, 0.0};
      for (int picture = first; picture <= last; ++picture) {
        const double pixels = joint[static_cast<std::size_t>(level * kLevels + picture)];
        pair.weight += pixels;
        pair.picture += pixels * picture;
      }
      if (!(pair.weight > 0.0)) continue;
      pair.picture /= pair.weight;
      near.push_back(pair);
    }
    line = Fit(near, line);
  }
  return line;
}

}  // namespace

recon::ExposureChange EstimateExposureSlowly(const cv::Mat& image_bgr, const cv::Mat& mean_bgr) {
  core::Require(
      image_bgr.type() == CV_8UC3 && mean_bgr.type() == CV_32FC3 && image_bgr.size() == mean_bgr.size(),
      "exposure is estimated from an 8-bit picture and a background mean of one size");
  recon::ExposureChange change;
  for (int channel = 0; channel < 3; ++channel) {
    const JointHistogram joint = JointHistogramOf(image_bgr, mean_bgr, channel);
    std::vector<LevelPair> pairs;
    for (int level = kDarkestLevel; level <= kBrightestLevel; ++level) {
      const LevelPair pair = MedianOf(joint, level);
      if (pair.weight > 0.0 && pair.picture >= kDarkestLevel && pair.picture <= kBrightestLevel)
        pairs.push_back(pair);
    }
    const Line line = Refined(joint, FitMedians(pairs));
    change.gain[static_cast<std::size_t>(channel)] = line.gain;
    change.offset_levels[static_cast<std::size_t>(channel)] = line.offset;
  }
  return change;
}

cv::Mat WithExposure(const cv::Mat& mean_bgr, const recon::ExposureChange& change) {
  core::Require(mean_bgr.type() == CV_32FC3, "a background mean is CV_32FC3");
  cv::Mat changed(mean_bgr.size(), CV_32FC3);
  float gain[3], offset[3];
  for (std::size_t c = 0; c < 3; ++c) {
    gain[c] = static_cast<float>(change.gain[c]);
    offset[c] = static_cast<float>(change.offset_levels[c]);
  }
  for (int y = 0; y < mean_bgr.rows; ++y) {
    const auto* in = mean_bgr.ptr<float>(y);
    auto* out = changed.ptr<float>(y);
    for (int x = 0; x < mean_bgr.cols; ++x) {
      for (int c = 0; c < 3; ++c)
        out[3 * x + c] = std::clamp(gain[c] * in[3 * x + c] + offset[c], 0.0F, 255.0F);
    }
  }
  return changed;
}

bool IsOutsideExactly(double level, double mean, double threshold, double gain, double offset_levels,
                      double by_levels) {
  const double lowest = std::clamp(gain * (mean - threshold) + offset_levels, 0.0, kLastLevel);
  const double highest = std::clamp(gain * (mean + threshold) + offset_levels, 0.0, kLastLevel);
  return level < lowest - by_levels || level > highest + by_levels;
}

core::BitMask OutsidePixels(const cv::Mat& image_bgr, const cv::Mat& mean_bgr, const cv::Mat& threshold_bgr,
                            const recon::FixedExposure& exposure) {
  core::BitMask outside(image_bgr.cols, image_bgr.rows);
  for (int y = 0; y < image_bgr.rows; ++y) {
    for (int x = 0; x < image_bgr.cols; ++x) {
      bool is_outside = false;
      for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        const double mean = mean_bgr.at<cv::Vec3f>(y, x)[c], threshold = threshold_bgr.at<cv::Vec3f>(y, x)[c];
        // In sixteenths of a level, as docs/segmentation.md words it.
        const auto changed = [&](double level) {
          const long sixty_fourths = std::lround(std::clamp(64.0 * level, -256.0 * 64.0, 32767.0));
          const double product = static_cast<double>(sixty_fourths * exposure.gain[channel]) / 32768.0;
          return std::clamp(std::floor(product + 0.5) + exposure.offset[channel], -32768.0, 32767.0);
        };
        const double lowest = std::clamp(std::ceil(changed(mean - threshold) / 16.0), 0.0, kLastLevel);
        const double highest = std::clamp(std::floor(changed(mean + threshold) / 16.0), 0.0, kLastLevel);
        const double level = image_bgr.at<cv::Vec3b>(y, x)[c];
        is_outside |= level < lowest || level > highest;
      }
      outside.Set(x, y, is_outside);
    }
  }
  return outside;
}

}  // namespace elbowroom::oracles
