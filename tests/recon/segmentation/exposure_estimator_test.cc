#include "recon/segmentation/exposure_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/oracles/exposure_oracle.h"

namespace elbowroom::recon {
namespace {

constexpr int kEstimateWidth = 640, kEstimateHeight = 480, kBackgroundFrames = 30;

enum class Ground { kDarkCloth, kGreyWall, kCheckered, kBrightWithWindow };
constexpr Ground kGrounds[] = {Ground::kDarkCloth, Ground::kGreyWall, Ground::kCheckered,
                               Ground::kBrightWithWindow};

cv::Mat GroundLevels(Ground ground, std::mt19937& random) {
  cv::Mat levels(kEstimateHeight, kEstimateWidth, CV_32FC3);
  cv::Mat coarse(12, 16, CV_32FC3), smooth;
  for (auto& value : cv::Mat_<cv::Vec3f>(coarse))
    for (int c = 0; c < 3; ++c) value[c] = static_cast<float>(random() % 1000U) / 1000.0F;
  cv::resize(coarse, smooth, levels.size(), 0, 0, cv::INTER_CUBIC);
  for (int y = 0; y < levels.rows; ++y) {
    for (int x = 0; x < levels.cols; ++x) {
      const auto& wave = smooth.at<cv::Vec3f>(y, x);
      auto& level = levels.at<cv::Vec3f>(y, x);
      const bool is_white = (x / 37 + y / 41) % 2 == 0;
      switch (ground) {
        case Ground::kDarkCloth:
          level = cv::Vec3f(30, 26, 22) + 20.0F * wave;
          break;
        case Ground::kGreyWall:
          level = cv::Vec3f(110, 112, 108) + 0.6F * wave;
          break;
        case Ground::kCheckered:
          level = is_white ? cv::Vec3f(190, 180, 170) : cv::Vec3f(50, 55, 60);
          break;
        case Ground::kBrightWithWindow:
          level = x > 480 && y < 200 ? cv::Vec3f(255, 255, 255) : cv::Vec3f(140, 150, 160) + 60.0F * wave;
          break;
      }
    }
  }
  return levels;
}

cv::Mat Shot(const cv::Mat& levels, double sigma, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, sigma);
  cv::Mat shot(levels.size(), CV_8UC3);
  for (int y = 0; y < levels.rows; ++y)
    for (int i = 0; i < 3 * levels.cols; ++i)
      shot.ptr<std::uint8_t>(y)[i] = cv::saturate_cast<std::uint8_t>(levels.ptr<float>(y)[i] + noise(random));
  return shot;
}

// The mean of kBackgroundFrames frames is off by noise itself.
BackgroundReference Measured(const cv::Mat& levels, double sigma, std::mt19937& random) {
  BackgroundReference background{levels.clone(), cv::Mat(levels.size(), CV_32FC3, cv::Scalar::all(sigma)),
                                 kBackgroundFrames};
  std::normal_distribution<double> error(0.0, sigma / std::sqrt(double{kBackgroundFrames}));
  for (auto& value : cv::Mat_<cv::Vec3f>(background.mean_bgr))
    for (int c = 0; c < 3; ++c)
      value[c] = std::clamp(value[c] + static_cast<float>(error(random)), 0.0F, 255.0F);
  return background;
}

// Objects over a share of the picture, of colours from black to white.
void Cover(cv::Mat* levels, double share, int trial) {
  const cv::Scalar colors[] = {{8, 8, 8}, {245, 240, 235}, {90, 120, 200}, {40, 40, 44}};
  const int width = static_cast<int>(share * levels->cols);
  (*levels)(cv::Rect((trial * 97) % (levels->cols - width), 0, width, levels->rows))
      .setTo(colors[static_cast<std::size_t>(trial) % 4]);
}

// How far the found background is off at the levels that the true one has: the worst of the 5th, 50th and
// 95th percentile, of the three channels.
double WorstErrorLevels(const ExposureChange& found, const ExposureChange& truth, const cv::Mat& levels) {
  double worst = 0.0;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    std::vector<float> sorted;
    for (const auto& value : cv::Mat_<cv::Vec3f>(levels)) sorted.push_back(value[c]);
    std::ranges::sort(sorted);
    for (const double at : {0.05, 0.5, 0.95}) {
      const double level = sorted[static_cast<std::size_t>(at * static_cast<double>(sorted.size() - 1))];
      const double wanted = truth.gain[channel] * level + truth.offset_levels[channel];
      if (wanted < 3.0 || wanted > 250.0) continue;  // clipped: nothing to find
      worst = std::max(worst, std::abs(found.gain[channel] * level + found.offset_levels[channel] - wanted));
    }
  }
  return worst;
}

ExposureChange RandomChange(std::mt19937& random) {
  ExposureChange change;
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 10000U) / 10000.0;
  };
  const double lamp = between(0.7, 1.32);  // 20 % of drift and 10 % of flicker
  for (std::size_t c = 0; c < 3; ++c)
    change.gain[c] = lamp * between(0.95, 1.05), change.offset_levels[c] = between(-6.0, 8.0);
  return change;
}

// A third of the picture is object.
TEST(ExposureEstimator, FindsTheBackgroundsLevelsBesideALargeObject) {
  constexpr double kNoiseLevels = 5.1;        // 2 % of 255, as the paper's cameras
  constexpr double kMostLevels = 0.25 * 5.1;  // so that 5 sigma stays 4.75 sigma
  std::mt19937 random(11);
  double worst = 0.0, worst_slow = 0.0;
  for (const Ground ground : kGrounds) {
    const cv::Mat levels = GroundLevels(ground, random);
    const BackgroundReference background = Measured(levels, kNoiseLevels, random);
    const ExposureEstimator estimator(background);
    for (int trial = 0; trial < 8; ++trial) {
      SCOPED_TRACE("ground " + std::to_string(static_cast<int>(ground)) + ", trial " + std::to_string(trial));
      const ExposureChange truth = RandomChange(random);
      cv::Mat lit = levels.clone();
      Cover(&lit, trial % 2 == 0 ? 1.0 / 3 : 0.1, trial);
      const cv::Mat picture = Shot(oracles::WithExposure(lit, truth), kNoiseLevels, random);
      const ExposureChange found = estimator.Estimate(picture);
      const double error = WorstErrorLevels(found, truth, levels);
      EXPECT_LE(error, kMostLevels);
      worst = std::max(worst, error);
      const ExposureChange slow = oracles::EstimateExposureSlowly(picture, background.mean_bgr);
      worst_slow = std::max(worst_slow, WorstErrorLevels(slow, truth, levels));
    }
  }
  RecordProperty("worst_levels", std::to_string(worst));
  RecordProperty("worst_slow_levels", std::to_string(worst_slow));
}

TEST(ExposureEstimator, GivesOneLevelAGainAlone) {
  std::mt19937 random(12);
  const cv::Mat levels(kEstimateHeight, kEstimateWidth, CV_32FC3, cv::Scalar(60, 90, 30));
  const ExposureEstimator estimator(
      {levels, cv::Mat(levels.size(), CV_32FC3, cv::Scalar::all(1.0)), kBackgroundFrames});
  const ExposureChange found = estimator.Estimate(
      Shot(oracles::WithExposure(levels, {{1.1, 0.9, 1.2}, {3.0, 0.0, 0.0}}), 1.0, random));
  constexpr double kRounding = 1e-6;  // of sums over 2,000 pixels
  constexpr double kGainTolerance = 0.005;
  EXPECT_NEAR(found.offset_levels[0], 0.0, kRounding);
  EXPECT_NEAR(found.gain[0], 69.0 / 60.0, kGainTolerance);
  EXPECT_NEAR(found.gain[1], 0.9, kGainTolerance);
  EXPECT_NEAR(found.gain[2], 1.2, kGainTolerance);
  EXPECT_GT(found.agreeing_share, 0.99);
}

TEST(ExposureEstimator, TellsWhenThePictureShowsAnythingElse) {
  std::mt19937 random(13);
  const cv::Mat levels = GroundLevels(Ground::kCheckered, random);
  const ExposureEstimator estimator(Measured(levels, 2.0, random));
  cv::Mat other(levels.size(), CV_8UC3);
  for (auto& value : cv::Mat_<cv::Vec3b>(other))
    for (int c = 0; c < 3; ++c) value[c] = static_cast<std::uint8_t>(random() % 256U);
  EXPECT_LT(estimator.Estimate(other).agreeing_share, 0.3);
}

TEST(ExposureEstimator, ChangesNothingWhereAllIsClipped) {
  const cv::Mat levels(60, 80, CV_32FC3, cv::Scalar(255, 1, 120));
  const ExposureEstimator estimator({levels, cv::Mat(levels.size(), CV_32FC3, cv::Scalar::all(1.0)), 30});
  const ExposureChange found = estimator.Estimate(cv::Mat(60, 80, CV_8UC3, cv::Scalar(255, 0, 100)));
  EXPECT_EQ(found.gain[0], 1.0);
  EXPECT_EQ(found.gain[1], 1.0);
  EXPECT_NEAR(found.gain[2], 100.0 / 120.0, 1e-6);
}

TEST(ExposureEstimator, NeverChoosesAnIgnoredPixel) {
  const cv::Mat levels(480, 640, CV_32FC3, cv::Scalar::all(100));
  const BackgroundReference background{levels, cv::Mat(levels.size(), CV_32FC3, cv::Scalar::all(1.0)), 30};
  core::BitMask ignore(640, 480);
  for (int y = 50; y < 250; ++y)
    for (int x = 100; x < 401; ++x) ignore.Set(x, y, true);
  const ExposureEstimator estimator(background, ignore);
  EXPECT_GT(estimator.places().size(), 1000U);
  EXPECT_LE(estimator.places().size(), static_cast<std::size_t>(ExposureEstimator::kSamples));
  for (const cv::Point& place : estimator.places()) EXPECT_FALSE(ignore.At(place.x, place.y));
  EXPECT_THROW(ExposureEstimator(background, core::BitMask(64, 48)), core::PreconditionError);
  EXPECT_THROW((void)estimator.Estimate(cv::Mat(48, 64, CV_8UC3)), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
