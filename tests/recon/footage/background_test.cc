#include "recon/footage/background.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

// A float holds the result to 6e-8 of itself, and levels go up to 255.
constexpr double kRoundingLevels = 2e-5;

TEST(BackgroundAccumulator, AgreesWithTwoPassesInDouble) {
  constexpr int kFrames = 57, kWidth = 13, kHeight = 5;
  std::mt19937 random(3);
  std::vector<cv::Mat> frames;
  BackgroundAccumulator accumulator;
  for (int i = 0; i < kFrames; ++i) {
    cv::Mat frame(kHeight, kWidth, CV_8UC3);
    for (int k = 0; k < kHeight * kWidth * 3; ++k) frame.data[k] = static_cast<std::uint8_t>(random() % 256U);
    frame.data[0] = 255;  // one channel that never changes
    accumulator.Add(frame);
    frames.push_back(frame);
  }
  const BackgroundReference reference = accumulator.Reference();
  EXPECT_EQ(reference.frames, kFrames);
  for (int k = 0; k < kHeight * kWidth * 3; ++k) {
    double mean = 0.0, scatter = 0.0;
    for (const cv::Mat& frame : frames) mean += frame.data[k] / static_cast<double>(kFrames);
    for (const cv::Mat& frame : frames) scatter += (frame.data[k] - mean) * (frame.data[k] - mean);
    EXPECT_NEAR(reference.mean_bgr.ptr<float>()[k], mean, kRoundingLevels);
    EXPECT_NEAR(reference.sigma_bgr.ptr<float>()[k], std::sqrt(scatter / (kFrames - 1)), kRoundingLevels);
  }
  EXPECT_EQ(reference.sigma_bgr.ptr<float>()[0], 0.0F);
}

TEST(BackgroundAccumulator, OneFrameHasNoNoise) {
  BackgroundAccumulator accumulator;
  accumulator.Add(cv::Mat(2, 2, CV_8UC3, cv::Scalar(1, 2, 3)));
  const BackgroundReference reference = accumulator.Reference();
  EXPECT_EQ(cv::countNonZero(reference.sigma_bgr.reshape(1)), 0);
  EXPECT_EQ(reference.mean_bgr.at<cv::Vec3f>(1, 1), cv::Vec3f(1, 2, 3));
}

TEST(BackgroundAccumulator, HoldsTheMostFramesThatItPromises) {
  BackgroundAccumulator accumulator;
  const cv::Mat white(1, 1, CV_8UC3, cv::Scalar(255, 255, 255)),
      grey(1, 1, CV_8UC3, cv::Scalar(254, 254, 254));
  for (int i = 0; i < BackgroundAccumulator::kMostFrames; ++i) accumulator.Add(i % 2 == 0 ? white : grey);
  const BackgroundReference reference = accumulator.Reference();
  EXPECT_NEAR(reference.mean_bgr.at<cv::Vec3f>(0, 0)[0], 254.5, kRoundingLevels);
  EXPECT_NEAR(reference.sigma_bgr.at<cv::Vec3f>(0, 0)[0], 0.5, kRoundingLevels);
  EXPECT_THROW(accumulator.Add(white), core::PreconditionError);
}

TEST(BackgroundAccumulator, RefusesWhatIsNoFrameOfIt) {
  BackgroundAccumulator accumulator;
  EXPECT_THROW((void)accumulator.Reference(), core::PreconditionError);
  EXPECT_THROW(accumulator.Add(cv::Mat(2, 2, CV_8U)), core::PreconditionError);
  accumulator.Add(cv::Mat::zeros(2, 2, CV_8UC3));
  EXPECT_THROW(accumulator.Add(cv::Mat::zeros(2, 3, CV_8UC3)), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
