#include "recon/segmentation/noise_threshold.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/error.h"
#include "recon/segmentation/ignored_pixels.h"

namespace elbowroom::recon {
namespace {

constexpr int kNoiseBins = 16;                            // of 16 levels, over which noise is pooled
constexpr int kSamplesOfChannel = 4096;                   // pixels that are simulated
constexpr int kMostSimulatedFrames = 200;                 // more make mean and noise exact enough
constexpr float kFirstLevel = 3.0F, kLastLevel = 252.0F;  // beyond: clipped

// A pixel and channel with its reference measured once more, in a simulation.
struct SimulatedPixel {
  double true_level = 0.0, true_sigma = 0.0;  // before rounding
  double mean = 0.0, sigma = 0.0;             // as measured
  double slack_levels = 0.0;
};

double NormalTail(double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2); }

// The probability that a pixel's rounded level is more than `threshold` away from its mean.
double OutsideRate(const SimulatedPixel& pixel, double threshold) {
  const double highest = std::floor(pixel.mean + threshold) + 0.5;
  const double lowest = std::ceil(pixel.mean - threshold) - 0.5;
  if (!(pixel.true_sigma > 0.0)) return pixel.true_level > highest || pixel.true_level < lowest ? 1.0 : 0.0;
  return NormalTail((highest - pixel.true_level) / pixel.true_sigma) +
         NormalTail((pixel.true_level - lowest) / pixel.true_sigma);
}

using Simulation = std::array<std::vector<SimulatedPixel>, 3>;  // a channel each

double RateOf(const Simulation& simulation, double k_sigma, double floor_levels) {
  double none_outside = 1.0;
  for (const auto& channel : simulation) {
    double outside = 0.0;
    for (const SimulatedPixel& pixel : channel)
      outside += OutsideRate(pixel, std::max(k_sigma * pixel.sigma, floor_levels) + pixel.slack_levels);
    if (!channel.empty()) none_outside *= 1.0 - outside / static_cast<double>(channel.size());
  }
  return 1.0 - none_outside;
}

// The noise of a channel by level.
class NoiseByLevel {
 public:
  void Add(float level, float sigma) {
    Bin& bin = bins_[BinOf(level)];
    bin.variance += static_cast<double>(sigma) * sigma;
    bin.pixels += 1.0;
  }
  [[nodiscard]] double SigmaAt(float level) const {
    const Bin& bin = bins_[BinOf(level)];
    return SigmaBeforeRounding(bin.variance / std::max(bin.pixels, 1.0));
  }

 private:
  struct Bin {
    double variance = 0.0, pixels = 0.0;
  };
  [[nodiscard]] static std::size_t BinOf(float level) {
    return std::min<std::size_t>(static_cast<std::size_t>(level) * kNoiseBins / 256, kNoiseBins - 1);
  }
  std::array<Bin, kNoiseBins> bins_;
};

class Simulator {
 public:
  Simulator(const BackgroundReference& background, double edge_slack_px, const core::BitMask& ignore)
      : background_(background), edge_slack_px_(edge_slack_px) {
    for (int y = 0; y < background.mean_bgr.rows; ++y)
      for (int x = 0; x < background.mean_bgr.cols; ++x)
        if (IsEmpty(ignore) || !ignore.At(x, y)) usable_.emplace_back(x, y);
    cv::Mat along_x, along_y;
    cv::Sobel(background.mean_bgr, along_x, CV_32F, 1, 0, 3, 1.0 / 8.0, 0.0, cv::BORDER_REPLICATE);
    cv::Sobel(background.mean_bgr, along_y, CV_32F, 0, 1, 3, 1.0 / 8.0, 0.0, cv::BORDER_REPLICATE);
    cv::magnitude(along_x.reshape(1), along_y.reshape(1), gradient_);
    // The least of 3 x 3 pixels: with little noise, means form steps of whole levels, and the pixels that
    // leave their step now and then lie beside its edge, where the gradient is small.
    cv::erode(gradient_.reshape(3), gradient_, cv::Mat());
  }

  [[nodiscard]] std::vector<SimulatedPixel> Channel(int channel, std::mt19937_64& random) const {
    NoiseByLevel noise;
    std::vector<cv::Point> places;
    for (const cv::Point& place : usable_) {
      const float level = background_.mean_bgr.at<cv::Vec3f>(place)[channel];
      if (level < kFirstLevel || level > kLastLevel) continue;
      noise.Add(level, background_.sigma_bgr.at<cv::Vec3f>(place)[channel]);
      places.push_back(place);
    }
    std::vector<SimulatedPixel> pixels;
    for (int i = 0; i < kSamplesOfChannel && !places.empty(); ++i) {
      const cv::Point& place = places[random() % places.size()];
      const float level = background_.mean_bgr.at<cv::Vec3f>(place)[channel];
      SimulatedPixel pixel;
      pixel.true_sigma = noise.SigmaAt(level);
      // Measured means of little noise crowd at whole levels, true ones don't.
      pixel.true_level = std::floor(static_cast<double>(level)) + Uniform(random);
      pixel.slack_levels = edge_slack_px_ * static_cast<double>(gradient_.at<cv::Vec3f>(place)[channel]);
      Measure(&pixel, random);
      pixels.push_back(pixel);
    }
    return pixels;
  }

 private:
  static double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1.0p-53; }

  void Measure(SimulatedPixel* pixel, std::mt19937_64& random) const {
    std::normal_distribution<double> normal(pixel->true_level, std::max(pixel->true_sigma, 1e-9));
    const int frames = std::min(background_.frames, kMostSimulatedFrames);
    double sum = 0.0, squares = 0.0;
    for (int frame = 0; frame < frames; ++frame) {
      const double level = std::floor(normal(random) + 0.5) - pixel->true_level;
      sum += level, squares += level * level;
    }
    pixel->mean = pixel->true_level + sum / frames;
    pixel->sigma = std::sqrt(std::max(squares - sum * sum / frames, 0.0) / (frames - 1));
  }

  const BackgroundReference& background_;
  double edge_slack_px_;
  std::vector<cv::Point> usable_;
  cv::Mat gradient_;  // CV_32FC3, levels a pixel
};

double TypicalSigma(const Simulation& simulation) {
  double variance = 0.0, pixels = 0.0;
  for (const auto& channel : simulation) {
    for (const SimulatedPixel& pixel : channel) variance += pixel.sigma * pixel.sigma;
    pixels += static_cast<double>(channel.size());
  }
  return std::sqrt(variance / pixels);
}

}  // namespace

double SigmaBeforeRounding(double rounded_variance) {
  const auto variance_of = [](double sigma) {
    double biased = 0.0;  // rounding moves the mean: this is no part of the variance
    for (int k = 1; k <= 8; ++k) {
      const double wave = 2.0 * std::numbers::pi * k;
      biased += 2.0 * std::exp(-wave * wave * sigma * sigma) / (wave * wave);
    }
    return sigma * sigma + 1.0 / 12.0 - biased;
  };
  double low = 0.0, high = 256.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (variance_of(middle) < rounded_variance ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::optional<NoiseThreshold> SuggestThreshold(const BackgroundReference& background, double wanted_rate,
                                               double edge_slack_px, const core::BitMask& ignore) {
  if (!(wanted_rate >= 1e-9 && wanted_rate <= 0.1)) {
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("a threshold for a false-positive rate of {} was asked for, but it must be "
                                  "in 1e-9..0.1 for a pixel and frame",
                                  wanted_rate));
  }
  const cv::Size size = background.mean_bgr.size();
  core::Require(background.mean_bgr.type() == CV_32FC3 && !background.mean_bgr.empty() &&
                    background.sigma_bgr.type() == CV_32FC3 && background.sigma_bgr.size() == size,
                "a background reference has mean and sigma, CV_32FC3 of one size");
  core::Require(IsEmpty(ignore) || (ignore.width_px() == size.width && ignore.height_px() == size.height),
                "an ignore mask is of its background's size");
  if (background.frames < 2) return std::nullopt;
  const Simulator simulator(background, edge_slack_px, ignore);
  std::mt19937_64 random(1);
  Simulation simulation;
  for (int channel = 0; channel < 3; ++channel)
    simulation[static_cast<std::size_t>(channel)] = simulator.Channel(channel, random);
  if (std::ranges::all_of(simulation, [](const auto& channel) { return channel.empty(); }))
    return std::nullopt;
  constexpr double kLeastFloorLevels = 0.5;  // what rounding alone may do
  const double typical = TypicalSigma(simulation);
  const auto with = [&](double k_sigma) {
    NoiseThreshold threshold{k_sigma, std::clamp(k_sigma * typical, kLeastFloorLevels, 255.0), 0.0};
    threshold.false_positive_rate = RateOf(simulation, threshold.k_sigma, threshold.floor_levels);
    return threshold;
  };
  double low = 0.1, high = 50.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (with(middle).false_positive_rate > wanted_rate ? low : high) = middle;
  }
  return with(high);
}

}  // namespace elbowroom::recon
