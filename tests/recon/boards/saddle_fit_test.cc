// The fit of one crossing: how exact, and what it refuses.
#include "recon/boards/saddle_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// Levels around a crossing at `at`: light where both lattice coordinates have one sign. The mean of 400
// places a pixel, blurred as a lens does: without it, edges along pixels say little of where they are.
cv::Mat Crossing(const Vector2d& at, const Matrix2d& pixel_from_squares, double noise, unsigned seed) {
  cv::Mat picture(61, 61, CV_32F);
  const Matrix2d squares_from_pixel = pixel_from_squares.inverse();
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int y = 0; y < 61; ++y) {
    for (int x = 0; x < 61; ++x) {
      int light = 0;
      for (int k = 0; k < 400; ++k) {
        const Vector2d place(x + (k % 20 + 0.5) / 20.0 - 0.5, y + (k / 20 + 0.5) / 20.0 - 0.5);
        const Vector2d q = squares_from_pixel * (place - at);
        light += q.x() * q.y() > 0.0 ? 1 : 0;
      }
      picture.at<float>(y, x) = 50.0F + 150.0F * static_cast<float>(light) / 400.0F;
    }
  }
  cv::GaussianBlur(picture, picture, {}, 0.6);
  for (int y = 0; y < 61; ++y)
    for (int x = 0; x < 61; ++x) picture.at<float>(y, x) += static_cast<float>(noise * normal(random));
  cv::Mat grey;
  picture.convertTo(grey, CV_8U);
  return grey;
}

Matrix2d Axes(double length1, double angle1, double length2, double angle2) {
  Matrix2d axes;
  axes << length1 * std::cos(angle1), length2 * std::cos(angle2), length1 * std::sin(angle1),
      length2 * std::sin(angle2);
  return axes;
}

TEST(SaddleFit, IsWithinAFiftiethOfAPixelWithoutNoise) {
  for (const Matrix2d& axes :
       {Axes(20.0, 0.0, 20.0, 1.57), Axes(24.0, 0.4, 18.0, 1.8), Axes(30.0, 0.2, 12.0, 0.9)}) {
    for (const Vector2d& at : {Vector2d(30.0, 30.0), Vector2d(30.37, 29.81), Vector2d(29.5, 30.5)}) {
      const LocalLattice near{at + Vector2d(1.3, -0.9), axes};
      const cv::Mat picture = Crossing(at, axes, 0.0, 1);
      const auto first = FitSaddle(picture, near, {});
      ASSERT_TRUE(first.has_value());
      // The window must lie evenly around the crossing.
      const auto fit = FitSaddle(picture, {first->pixel, axes}, {});
      ASSERT_TRUE(fit.has_value());
      EXPECT_LT((fit->pixel - at).norm(), 0.02);
    }
  }
}

TEST(SaddleFit, SigmaIsThatOfTheErrors) {
  const Matrix2d axes = Axes(20.0, 0.3, 13.0, 1.6);
  double sum = 0.0;
  constexpr int kPictures = 200;
  for (unsigned i = 0; i < kPictures; ++i) {
    const Vector2d at(30.0 + 0.01 * i, 30.2);
    const auto fit = FitSaddle(Crossing(at, axes, 6.0, i), {at + Vector2d(0.5, 0.5), axes}, {});
    ASSERT_TRUE(fit.has_value());
    sum += (fit->pixel - at).squaredNorm() / (fit->sigma_px * fit->sigma_px);
  }
  const double rms = std::sqrt(sum / (2.0 * kPictures));
  EXPECT_GT(rms, 0.7);
  EXPECT_LT(rms, 1.4);
}

TEST(SaddleFit, RefusesWhatIsNoCrossing) {
  const Matrix2d axes = Axes(20.0, 0.0, 20.0, 1.57);
  const LocalLattice near{{30.0, 30.0}, axes};
  EXPECT_FALSE(FitSaddle(cv::Mat(61, 61, CV_8U, cv::Scalar(90)), near, {})) << "flat";
  cv::Mat edge(61, 61, CV_8U, cv::Scalar(40));
  edge.colRange(30, 61).setTo(200);
  EXPECT_FALSE(FitSaddle(edge, near, {})) << "an edge";
  cv::Mat corner = edge.clone();
  corner.rowRange(0, 30).setTo(200);
  EXPECT_FALSE(FitSaddle(corner, near, {})) << "a corner";
  const cv::Mat crossing = Crossing({30.0, 30.0}, axes, 0.0, 1);
  EXPECT_FALSE(FitSaddle(crossing, near, {.sign = -1})) << "light and dark exchanged";
  EXPECT_FALSE(FitSaddle(crossing, {{5.0, 30.0}, axes}, {})) << "partly outside the picture";
  EXPECT_FALSE(FitSaddle(crossing, {{44.0, 44.0}, axes}, {})) << "elsewhere";
}

}  // namespace
}  // namespace elbowroom::recon
