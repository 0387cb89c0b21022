#include "recon/segmentation/noise_threshold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>

#include "core/error.h"
#include "recon/footage/background.h"
#include "recon/segmentation/segmentation.h"

namespace elbowroom::recon {
namespace {

// An empty scene of smooth levels from 30 to 180, and pictures of it with noise that is rounded.
class NoisyScene {
 public:
  // `shot`: variance of the noise a level, beside that of sigma.
  NoisyScene(double sigma, double shot, std::uint32_t seed) : sigma_(sigma), shot_(shot), random_(seed) {
    for (int y = 0; y < levels_.rows; ++y)
      for (int x = 0; x < levels_.cols; ++x)
        levels_.at<cv::Vec3f>(y, x) =
            cv::Vec3f(30.0F + 0.37F * static_cast<float>(x), 60.0F + 0.23F * static_cast<float>(y),
                      100.0F + 0.11F * static_cast<float>(x + y));
  }

  [[nodiscard]] cv::Mat Picture() {
    std::normal_distribution<double> normal;
    cv::Mat picture(levels_.size(), CV_8UC3);
    for (int y = 0; y < levels_.rows; ++y) {
      const auto* level = levels_.ptr<float>(y);
      for (int i = 0; i < 3 * levels_.cols; ++i) {
        const double sigma = std::sqrt(sigma_ * sigma_ + shot_ * static_cast<double>(level[i]));
        picture.ptr<std::uint8_t>(y)[i] = cv::saturate_cast<std::uint8_t>(
            std::floor(static_cast<double>(level[i]) + sigma * normal(random_) + 0.5));
      }
    }
    return picture;
  }

  [[nodiscard]] BackgroundReference Background(int frames) {
    BackgroundAccumulator background;
    for (int frame = 0; frame < frames; ++frame) background.Add(Picture());
    return background.Reference();
  }

  // Candidates of all pixels, by Segmenter itself.
  [[nodiscard]] double RateWith(const BackgroundReference& background, const NoiseThreshold& threshold,
                                int frames) {
    SegmentationOptions options;
    options.k_sigma = threshold.k_sigma, options.floor_levels = threshold.floor_levels;
    options.min_blob_px = options.max_hole_px = 0;
    options.shadows = ShadowRule::kKeep;
    const Segmenter segmenter(background, options);
    double found = 0.0;
    for (int frame = 0; frame < frames; ++frame)
      found += static_cast<double>(segmenter.Segment(Picture()).CountObjectPixels());
    return found / (static_cast<double>(levels_.total()) * frames);
  }

 private:
  double sigma_, shot_;
  std::mt19937 random_;
  cv::Mat levels_ = cv::Mat(240, 320, CV_32FC3);
};

constexpr double kEdgeSlackPx = 0.8;  // the default

struct NoiseCase {
  double sigma, shot;
  int frames;
};

// Noise of which a pixel's level hardly ever leaves a whole one, up to 2 % of the range; alike everywhere, or
// growing with the light; references of few frames and of many.
TEST(NoiseThreshold, GivesTheWantedRateWithinAFactorOfTwo) {
  constexpr double kFactor = 2.0;
  constexpr int kRateFrames = 20;  // 1.5 million pixels: 154 at the least rate
  for (const NoiseCase& noise :
       {NoiseCase{0.4, 0.0, 30}, NoiseCase{0.7, 0.0, 30}, NoiseCase{1.5, 0.0, 10}, NoiseCase{1.5, 0.0, 100},
        NoiseCase{5.1, 0.0, 30}, NoiseCase{0.5, 0.05, 30}}) {
    NoisyScene scene(noise.sigma, noise.shot, 5);
    const BackgroundReference background = scene.Background(noise.frames);
    for (const double wanted : {1e-2, 1e-3, 1e-4}) {
      const auto threshold = SuggestThreshold(background, wanted, kEdgeSlackPx);
      ASSERT_TRUE(threshold.has_value());
      const double rate = scene.RateWith(background, *threshold, kRateFrames);
      const std::string what = "sigma " + std::to_string(noise.sigma) + ", frames " +
                               std::to_string(noise.frames) + ", wanted " + std::to_string(wanted) + ", k " +
                               std::to_string(threshold->k_sigma) + ", floor " +
                               std::to_string(threshold->floor_levels) + ", predicted " +
                               std::to_string(threshold->false_positive_rate);
      EXPECT_LE(rate, kFactor * wanted) << what;
      EXPECT_GE(rate, wanted / kFactor) << what;
    }
  }
}

// Below a third of a level of noise, levels are often one whole number or two, and no threshold gives just
// any rate.
TEST(NoiseThreshold, StaysBelowTheWantedRateWhereRoundingLeavesNoChoice) {
  constexpr double kFactor = 2.0;
  for (const double sigma : {0.0, 0.1, 0.2, 0.3}) {
    NoisyScene scene(sigma, 0.0, 6);
    const BackgroundReference background = scene.Background(30);
    for (const double wanted : {1e-2, 1e-3, 1e-4}) {
      const auto threshold = SuggestThreshold(background, wanted, kEdgeSlackPx);
      ASSERT_TRUE(threshold.has_value());
      EXPECT_LE(scene.RateWith(background, *threshold, 20), kFactor * wanted) << sigma << ' ' << wanted;
      EXPECT_LE(threshold->floor_levels, 3.0) << sigma << ": far more than the noise";
    }
  }
}

TEST(NoiseThreshold, FindsTheNoiseBeforeRounding) {
  std::mt19937 random(8);
  for (const double sigma : {0.15, 0.3, 0.6, 2.0}) {
    std::normal_distribution<double> normal(0.0, sigma);
    double variance = 0.0;
    constexpr int kLevels = 400, kFrames = 400;
    for (int i = 0; i < kLevels; ++i) {
      double sum = 0.0, squares = 0.0;
      for (int frame = 0; frame < kFrames; ++frame) {
        const double level = std::floor(static_cast<double>(i) / kLevels + normal(random) + 0.5);
        sum += level, squares += level * level;
      }
      variance += (squares - sum * sum / kFrames) / (kFrames - 1) / kLevels;
    }
    EXPECT_NEAR(SigmaBeforeRounding(variance), sigma, 0.02 * sigma + 0.003) << sigma;
  }
  EXPECT_NEAR(SigmaBeforeRounding(0.0), 0.0, 0.08);  // flat there: a variance of 1e-9 is a sigma of 0.08
}

TEST(NoiseThreshold, SaysNothingOfOneFrameAndRefusesRatesThatMakeNoSense) {
  NoisyScene scene(2.0, 0.0, 7);
  EXPECT_FALSE(SuggestThreshold(scene.Background(1), 1e-3, kEdgeSlackPx).has_value());
  const BackgroundReference background = scene.Background(5);
  core::BitMask all(320, 240);
  for (auto& word : all.words()) word = ~std::uint64_t{0};
  EXPECT_FALSE(SuggestThreshold(background, 1e-3, kEdgeSlackPx, all).has_value());
  EXPECT_THROW((void)SuggestThreshold(background, 0.0, kEdgeSlackPx), core::Error);
  EXPECT_THROW((void)SuggestThreshold(background, 0.5, kEdgeSlackPx), core::Error);
  EXPECT_THROW((void)SuggestThreshold(background, std::nan(""), kEdgeSlackPx), core::Error);
  EXPECT_THROW((void)SuggestThreshold(background, 1e-3, kEdgeSlackPx, core::BitMask(3, 3)),
               core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
