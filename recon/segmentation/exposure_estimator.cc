#include "recon/segmentation/exposure_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "recon/segmentation/ignored_pixels.h"

namespace elbowroom::recon {
namespace {

// Levels near the ends of the range are clipped by the sensor and say nothing of the exposure.
constexpr float kDarkestLevel = 3.0F, kBrightestLevel = 250.0F;
// What a background pixel may differ by beside its noise: rounding, compression, uneven light.
constexpr float kModelSigmaLevels = 1.0F;
// Lamps and cameras change light by a factor; an offset is rare and small. One standard deviation of it.
constexpr double kOffsetSigmaLevels = 10.0;

// The squared distance in three channels, in their noise, from which on a pixel is no background: chi-squared
// with three degrees of freedom is above 16 once in a thousand times.
constexpr float kCut2 = 16.0F;

bool CanBeFollowed(float gain, float offset) {
  return gain >= static_cast<float>(kLeastGain) && gain <= static_cast<float>(kMostGain) &&
         std::abs(offset) <= static_cast<float>(kMostOffsetLevels);
}

// Reorders the values.
float MedianOf(std::vector<float>& values) {
  if (values.empty()) return 0.0F;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

bool IsClipped(float level) { return level < kDarkestLevel || level > kBrightestLevel; }

}  // namespace

ExposureEstimator::ExposureEstimator(const BackgroundReference& background, const core::BitMask& ignore,
                                     int samples)
    : size_(background.mean_bgr.size()) {
  core::Require(background.mean_bgr.type() == CV_32FC3 && !background.mean_bgr.empty() &&
                    background.sigma_bgr.type() == CV_32FC3 && background.sigma_bgr.size() == size_,
                "a background reference has mean and sigma, CV_32FC3 of one size");
  core::Require(IsEmpty(ignore) || (ignore.width_px() == size_.width && ignore.height_px() == size_.height),
                "an ignore mask is of its background's size");
  core::Require(samples > 0 && samples <= kSamples, "there are 1 to kSamples samples");
  ChoosePlaces(background.mean_bgr, ignore, samples);
  for (const cv::Point& place : places_) {
    const auto &mean = background.mean_bgr.at<cv::Vec3f>(place),
               &sigma = background.sigma_bgr.at<cv::Vec3f>(place);
    for (std::size_t c = 0; c < 3; ++c) {
      const float level = mean[static_cast<int>(c)], noise = sigma[static_cast<int>(c)];
      mean_[c].push_back(level);
      per_variance_[c].push_back(
          IsClipped(level) ? 0.0F : 1.0F / (noise * noise + kModelSigmaLevels * kModelSigmaLevels));
      mean_variance_[c] += static_cast<double>(noise) * noise;
    }
  }
  for (double& variance : mean_variance_)
    variance /=
        static_cast<double>(std::max<std::size_t>(places_.size(), 1)) * std::max(background.frames, 1);
  SortIntoBins();
}

void ExposureEstimator::SortIntoBins() {
  constexpr std::size_t kOfEvery = 2, kScoredOfEvery = 4;  // enough for lines that are refined later
  const std::size_t n = places_.size();
  std::vector<std::uint16_t> by_light(n);
  std::iota(by_light.begin(), by_light.end(), std::uint16_t{0});
  std::ranges::stable_sort(by_light, {},
                           [&](std::uint16_t i) { return mean_[0][i] + mean_[1][i] + mean_[2][i]; });
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    for (std::size_t i = n * bin / kBins; i < n * (bin + 1) / kBins; i += kOfEvery)
      bins_[bin].push_back(by_light[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<float> means;
      for (const std::uint16_t i : bins_[bin]) means.push_back(mean_[c][i]);
      bin_mean_[bin][c] = MedianOf(means);
    }
  }
  for (std::size_t i = 0; i < n; i += kScoredOfEvery) {
    scored_.push_back(static_cast<std::uint16_t>(i));
    for (std::size_t c = 0; c < 3; ++c) {
      scored_mean_[c].push_back(mean_[c][i]);
      scored_per_variance_[c].push_back(per_variance_[c][i]);
    }
  }
}

void ExposureEstimator::ChoosePlaces(const cv::Mat& mean_bgr, const core::BitMask& ignore, int samples) {
  cv::Mat along_x, along_y;
  cv::Sobel(mean_bgr, along_x, CV_32F, 1, 0, 3, 1.0 / 8.0, 0.0, cv::BORDER_REPLICATE);
  cv::Sobel(mean_bgr, along_y, CV_32F, 0, 1, 3, 1.0 / 8.0, 0.0, cv::BORDER_REPLICATE);
  // Rounded up, so that there are at most `samples` squares and their numbers fit 16 bits.
  const int side =
      std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(mean_bgr.total()) / samples))));
  for (int top = 0; top + side <= size_.height; top += side) {
    for (int left = 0; left + side <= size_.width; left += side) {
      cv::Point best(-1, -1);
      double least = std::numeric_limits<double>::infinity();
      for (int y = top; y < top + side; ++y) {
        for (int x = left; x < left + side; ++x) {
          if (!IsEmpty(ignore) && ignore.At(x, y)) continue;
          const auto& mean = mean_bgr.at<cv::Vec3f>(y, x);
          constexpr double kClippedIsWorse = 1e6;
          const double rank =
              cv::norm(along_x.at<cv::Vec3f>(y, x), cv::NORM_L2SQR) +
              cv::norm(along_y.at<cv::Vec3f>(y, x), cv::NORM_L2SQR) +
              kClippedIsWorse * (IsClipped(mean[0]) + IsClipped(mean[1]) + IsClipped(mean[2]));
          if (rank < least) least = rank, best = {x, y};
        }
      }
      if (best.x >= 0) places_.push_back(best);
    }
  }
}

// The sum over the scored pixels of how far they are off in all channels, in their noise, cut off where a
// pixel is surely no background. In lanes of their own, so that the compiler makes vectors of them.
float ExposureEstimator::MisfitOf(const Lines& lines, const Levels& scored) const {
  constexpr std::size_t kLanes = 8;
  std::array<float, kLanes> sums{};
  const std::size_t whole = scored_.size() / kLanes * kLanes;
  for (std::size_t begin = 0; begin < whole; begin += kLanes) {
    std::array<float, kLanes> off2{};
    for (std::size_t c = 0; c < 3; ++c) {
      const float *mean = &scored_mean_[c][begin], *per_variance = &scored_per_variance_[c][begin];
      const float *level = &scored[c][begin], gain = lines[c].gain, offset = lines[c].offset;
      for (std::size_t k = 0; k < kLanes; ++k) {
        const float residual = level[k] - gain * mean[k] - offset;
        off2[k] += residual * residual * per_variance[k];
      }
    }
    for (std::size_t k = 0; k < kLanes; ++k) sums[k] += off2[k] < kCut2 ? off2[k] : kCut2;
  }
  return std::accumulate(sums.begin(), sums.end(), 0.0F);
}

// The best of some lines through medians. The pixels are divided by their background's light into bins. In a
// bin that objects cover less than half of, the medians lie on the lines; of these, two give them, or one and
// gains alone.
ExposureEstimator::Lines ExposureEstimator::FirstLines(const Levels& picture) const {
  std::array<std::array<float, 3>, kBins> bin_picture{};
  std::vector<float> changes;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    for (std::size_t c = 0; c < 3; ++c) {
      changes.clear();
      for (const std::uint16_t i : bins_[bin]) changes.push_back(picture[c][i] - mean_[c][i]);
      bin_picture[bin][c] = bin_mean_[bin][c] + MedianOf(changes);
    }
  }
  Levels scored;
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::uint16_t i : scored_) scored[c].push_back(picture[c][i]);
  Lines best;
  float least = MisfitOf(best, scored);
  const auto consider = [&](const auto& line_of_channel) {
    Lines lines;
    for (std::size_t c = 0; c < 3; ++c) {
      const Line line = line_of_channel(c);
      if (CanBeFollowed(line.gain, line.offset)) lines[c] = line;
    }
    const float misfit = MisfitOf(lines, scored);
    if (misfit < least) least = misfit, best = lines;
  };
  for (std::size_t a = 0; a < kBins; ++a) {
    consider([&](std::size_t c) { return Line{bin_picture[a][c] / bin_mean_[a][c], 0.0F}; });
    for (std::size_t b = a + 1; b < kBins; ++b) {
      consider([&](std::size_t c) {
        const float gain = (bin_picture[b][c] - bin_picture[a][c]) / (bin_mean_[b][c] - bin_mean_[a][c]);
        return Line{gain, bin_picture[a][c] - gain * bin_mean_[a][c]};
      });
    }
  }
  return best;
}

// One step of iterated least squares with Tukey's weights (1 - r^2 / cut^2)^2, where r is how far a pixel is
// off in all channels. Returns how many pixels have a weight.
std::size_t ExposureEstimator::Refine(double cut2, const Levels& picture, Lines* lines) const {
  struct Sums {
    double w = 0.0, b = 0.0, p = 0.0, bb = 0.0, bp = 0.0;
  };
  std::array<Sums, 3> sums;
  const auto per_cut2 = static_cast<float>(1.0 / cut2);
  std::size_t agreeing = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    std::array<float, 3> per_variance{};
    float off2 = 0.0F, known = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) {
      const float expected = (*lines)[c].gain * mean_[c][i] + (*lines)[c].offset;
      const float residual = picture[c][i] - expected;
      per_variance[c] = IsClipped(expected) ? 0.0F : per_variance_[c][i];
      off2 += residual * residual * per_variance[c];
      known += per_variance[c];
    }
    const float rest = 1.0F - off2 * per_cut2;
    if (rest <= 0.0F || known <= 0.0F) continue;
    ++agreeing;
    for (std::size_t c = 0; c < 3; ++c) {
      const double weight = static_cast<double>(rest * rest * per_variance[c]);
      const auto background = static_cast<double>(mean_[c][i]), level = static_cast<double>(picture[c][i]);
      sums[c].w += weight, sums[c].b += weight * background, sums[c].p += weight * level;
      sums[c].bb += weight * background * background, sums[c].bp += weight * background * level;
    }
  }
  if (agreeing < kLeastSamples) return agreeing;
  for (std::size_t c = 0; c < 3; ++c) {
    // Least squares with offset ~ N(0, kOffsetSigmaLevels). The background's own error is taken out of its
    // spread, or the slope would be too flat.
    const auto& [w, b, p, bb_measured, bp] = sums[c];
    if (!(w > 0.0)) continue;
    const double bb = std::max(bb_measured - w * mean_variance_[c], b * b / w);
    const double w_prior = w + 1.0 / (kOffsetSigmaLevels * kOffsetSigmaLevels);
    const double determinant = bb * w_prior - b * b;
    if (!(determinant > 0.0)) continue;
    (*lines)[c] = {
        static_cast<float>(std::clamp((bp * w_prior - b * p) / determinant, kLeastGain, kMostGain)),
        static_cast<float>(
            std::clamp((bb * p - b * bp) / determinant, -kMostOffsetLevels, kMostOffsetLevels))};
  }
  return agreeing;
}

ExposureChange ExposureEstimator::Estimate(const cv::Mat& image_bgr) const {
  core::Require(image_bgr.type() == CV_8UC3 && image_bgr.size() == size_,
                "exposure is estimated from an 8-bit BGR picture of its background's size");
  Levels picture;
  for (auto& channel : picture) channel.resize(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto& pixel = image_bgr.at<cv::Vec3b>(places_[i]);
    for (std::size_t c = 0; c < 3; ++c) picture[c][i] = static_cast<float>(pixel[static_cast<int>(c)]);
  }
  constexpr ExposureChange kNone{{1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, 0.0};
  if (places_.size() < kLeastSamples) return kNone;
  Lines lines = FirstLines(picture);
  std::size_t agreeing = 0;
  // From wide, since the first lines are rough, to where one background pixel in a thousand is left out.
  for (const double wider : {4.0, 2.0, 1.4, 1.0, 1.0, 1.0}) {
    agreeing = Refine(wider * static_cast<double>(kCut2), picture, &lines);
    if (agreeing < kLeastSamples) return kNone;
  }
  ExposureChange change;
  change.agreeing_share = static_cast<double>(agreeing) / static_cast<double>(places_.size());
  for (std::size_t c = 0; c < 3; ++c) {
    change.gain[c] = static_cast<double>(lines[c].gain);
    change.offset_levels[c] = static_cast<double>(lines[c].offset);
  }
  return change;
}

}  // namespace elbowroom::recon
