#include "recon/segmentation/segmentation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/error.h"
#include "recon/images/mask_image.h"
#include "recon/segmentation/exposure.h"
#include "tests/oracles/exposure_oracle.h"
#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::HasSubstr;

constexpr int kWidth = 120;
constexpr int kHeight = 90;

// A background with a gradient and three colours, sigma_levels of noise everywhere.
BackgroundReference Background(float sigma_levels) {
  BackgroundReference background{cv::Mat(kHeight, kWidth, CV_32FC3),
                                 cv::Mat(kHeight, kWidth, CV_32FC3, cv::Scalar::all(sigma_levels)), 50};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      background.mean_bgr.at<cv::Vec3f>(y, x) =
          cv::Vec3f(40.0F + static_cast<float>(x), 90.0F + static_cast<float>(y), 60.0F);
    }
  }
  return background;
}

cv::Mat PictureOf(const cv::Mat& mean_bgr, double noise_levels = 0.0, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, std::max(noise_levels, 1e-9));
  cv::Mat picture(mean_bgr.size(), CV_8UC3);
  for (int i = 0; i < mean_bgr.rows * mean_bgr.cols * 3; ++i) {
    picture.data[i] = cv::saturate_cast<std::uint8_t>(mean_bgr.ptr<float>()[i] + noise(random));
  }
  return picture;
}

// Subtraction with thresholds and nothing else.
SegmentationOptions Bare() {
  SegmentationOptions options;
  options.k_sigma = 4.0, options.floor_levels = 10.0, options.edge_slack_px = 0.0;
  options.min_blob_px = 0, options.max_hole_px = 0;
  options.shadows = ShadowRule::kKeep;
  return options;
}

TEST(Segmentation, IsTheFormulaPixelByPixel) {
  std::mt19937 random(9);
  BackgroundReference background = Background(0.0F);
  for (int i = 0; i < kWidth * kHeight * 3; ++i) {
    background.mean_bgr.ptr<float>()[i] = static_cast<float>(random() % 25600U) / 100.0F;
    background.sigma_bgr.ptr<float>()[i] = static_cast<float>(random() % 600U) / 100.0F;
  }
  const cv::Mat picture = PictureOf(background.mean_bgr, 12.0, 2);
  const SegmentationOptions options = Bare();
  const core::BitMask mask = Segmenter(background, options).Segment(picture);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      bool object = false;
      for (int c = 0; c < 3; ++c) {
        const float mean = background.mean_bgr.at<cv::Vec3f>(y, x)[c];
        const float sigma = background.sigma_bgr.at<cv::Vec3f>(y, x)[c];
        const double difference = std::abs(picture.at<cv::Vec3b>(y, x)[c] - static_cast<double>(mean));
        object |= difference > std::max(4.0F * sigma, 10.0F);
      }
      ASSERT_EQ(mask.At(x, y), object) << x << ' ' << y;
    }
  }
}

TEST(Segmentation, NoiseAloneIsNoObjectAndAnUntouchedSceneIsEmpty) {
  const BackgroundReference background = Background(3.0F);
  SegmentationOptions options;
  EXPECT_EQ(Segmenter(background, options).Segment(PictureOf(background.mean_bgr, 3.0)).CountObjectPixels(),
            0U);
  options.method = SegmentationMethod::kAdaptive;
  EXPECT_EQ(Segmenter(background, options).Segment(PictureOf(background.mean_bgr, 3.0)).CountObjectPixels(),
            0U);
}

TEST(Segmentation, RemovesSmallBlobsAndFillsSmallHoles) {
  const BackgroundReference background = Background(1.0F);
  cv::Mat picture = PictureOf(background.mean_bgr);
  const cv::Scalar red(20, 20, 250);
  picture(cv::Rect(10, 10, 40, 40)).setTo(red);  // 1600 px
  PictureOf(background.mean_bgr)(cv::Rect(15, 15, 3, 3))
      .copyTo(picture(cv::Rect(15, 15, 3, 3)));  // 9 px hole
  PictureOf(background.mean_bgr)(cv::Rect(30, 30, 9, 9))
      .copyTo(picture(cv::Rect(30, 30, 9, 9)));  // 81 px hole
  picture(cv::Rect(80, 60, 5, 5)).setTo(red);    // 25 px
  picture(cv::Rect(85, 65, 5, 5)).setTo(red);    // touches it by a corner: 50 px
  SegmentationOptions options = Bare();
  options.min_blob_px = 50, options.max_hole_px = 81;
  EXPECT_EQ(Segmenter(background, options).Segment(picture).CountObjectPixels(), 1600U - 81U + 50U);
  options.min_blob_px = 51, options.max_hole_px = 82;
  EXPECT_EQ(Segmenter(background, options).Segment(picture).CountObjectPixels(), 1600U);
}

TEST(Segmentation, KeepsABayAtThePicturesEdgeOpen) {
  const BackgroundReference background = Background(1.0F);
  cv::Mat picture = PictureOf(background.mean_bgr);
  picture(cv::Rect(0, 0, kWidth, 40)).setTo(cv::Scalar(20, 20, 250));
  const cv::Rect bay(50, 30, 4, 10);  // opens to the background below
  PictureOf(background.mean_bgr)(bay).copyTo(picture(bay));
  SegmentationOptions options = Bare();
  options.max_hole_px = 100;
  EXPECT_EQ(Segmenter(background, options).Segment(picture).CountObjectPixels(),
            static_cast<std::size_t>(kWidth * 40 - bay.area()));
}

TEST(Segmentation, RejectsShadeAndKeepsWhatIsDarkerInAnotherColour) {
  const BackgroundReference background = Background(1.0F);
  cv::Mat mean = background.mean_bgr.clone();
  const cv::Rect shade(5, 5, 30, 30), object(60, 5, 30, 30), black(5, 50, 30, 30);
  mean(shade) *= 0.7;
  mean(object).setTo(cv::Scalar(60, 60, 60));
  mean(black) *= 0.3;  // too dark for a shadow
  SegmentationOptions options;
  options.max_hole_px = 0;
  const core::BitMask mask = Segmenter(background, options).Segment(PictureOf(mean));
  const auto share = [&](const cv::Rect& area) {
    return cv::countNonZero(ImageFromMask(mask)(area)) / static_cast<double>(area.area());
  };
  EXPECT_EQ(share(shade), 0.0);
  EXPECT_GT(share(object), 0.95);  // where the gradient passes its colour it is shade by definition
  EXPECT_EQ(share(black), 1.0);
  options.shadows = ShadowRule::kKeep;
  EXPECT_EQ(cv::countNonZero(ImageFromMask(Segmenter(background, options).Segment(PictureOf(mean)))(shade)),
            shade.area());
}

TEST(Segmentation, EdgeSlackForgivesAShiftOfTheCamera) {
  BackgroundReference background = Background(0.5F);
  background.mean_bgr.setTo(cv::Scalar::all(60.0));
  background.mean_bgr(cv::Rect(60, 0, 60, kHeight)).setTo(cv::Scalar::all(160.0));
  cv::GaussianBlur(background.mean_bgr, background.mean_bgr, cv::Size(7, 7), 1.5);  // a lens is no knife
  cv::Mat shifted;
  const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1.0, 0.0, 0.5, 0.0, 1.0, 0.0);
  cv::warpAffine(background.mean_bgr, shifted, shift, shifted.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  SegmentationOptions options = Bare();
  EXPECT_GT(Segmenter(background, options).Segment(PictureOf(shifted)).CountObjectPixels(), 0U);
  options.edge_slack_px = 0.5;
  EXPECT_EQ(Segmenter(background, options).Segment(PictureOf(shifted)).CountObjectPixels(), 0U);
}

TEST(Segmentation, AdaptiveFollowsAChangeOfExposure) {
  const BackgroundReference background = Background(1.0F);
  const ExposureChange change{{1.25, 1.2, 1.3}, {6.0, -4.0, 3.0}};
  cv::Mat picture = PictureOf(oracles::WithExposure(background.mean_bgr, change), 1.0);
  const cv::Rect object(30, 20, 45, 40);  // a sixth of the picture
  picture(object).setTo(cv::Scalar(5, 10, 240));
  SegmentationOptions options;
  options.shadows = ShadowRule::kKeep;
  const auto far_too_much = Segmenter(background, options).Segment(picture).CountObjectPixels();
  EXPECT_GT(far_too_much, static_cast<std::size_t>(2 * object.area()));
  options.method = SegmentationMethod::kAdaptive;
  const core::BitMask mask = Segmenter(background, options).Segment(picture);
  EXPECT_EQ(mask.CountObjectPixels(), static_cast<std::size_t>(object.area()));
}

TEST(Segmentation, GivesOneMaskWhateverTheThreads) {
  const BackgroundReference background = Background(2.0F);
  cv::Mat picture = PictureOf(background.mean_bgr, 14.0, 5);
  SegmentationOptions options;
  options.min_blob_px = 9, options.max_hole_px = 9;
  const Segmenter segmenter(background, options);
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const core::BitMask single = segmenter.Segment(picture);
  cv::setNumThreads(4);
  const core::BitMask several = segmenter.Segment(picture);
  cv::setNumThreads(threads);
  EXPECT_GT(single.CountObjectPixels(), 0U);
  EXPECT_EQ(single, several);
}

TEST(SegmentationOptions, NamesTheOptionOutOfRange) {
  const auto message = [](auto change) {
    SegmentationOptions options;
    change(options);
    return testing::ErrorOf(ErrorKind::kRange, [&] { options.Validate(); });
  };
  EXPECT_THAT(message([](auto& o) { o.k_sigma = 0.0; }), HasSubstr("k_sigma"));
  EXPECT_THAT(message([](auto& o) { o.k_sigma = std::numeric_limits<double>::quiet_NaN(); }),
              HasSubstr("k_sigma"));
  EXPECT_THAT(message([](auto& o) { o.floor_levels = 256.0; }), HasSubstr("floor_levels"));
  EXPECT_THAT(message([](auto& o) { o.edge_slack_px = -0.1; }), HasSubstr("edge_slack_px"));
  EXPECT_THAT(message([](auto& o) { o.min_blob_px = -1; }), HasSubstr("min_blob_px"));
  EXPECT_THAT(message([](auto& o) { o.max_hole_px = -1; }), HasSubstr("max_hole_px"));
  EXPECT_THAT(message([](auto& o) { o.shadow_darkest = 1.5; }), HasSubstr("shadow_darkest"));
  EXPECT_THAT(message([](auto& o) { o.shadow_chroma = -1.0; }), HasSubstr("shadow_chroma"));
  EXPECT_EQ(ParseSegmentationMethod(ToString(SegmentationMethod::kAdaptive)), SegmentationMethod::kAdaptive);
  EXPECT_EQ(ParseShadowRule(ToString(ShadowRule::kReject)), ShadowRule::kReject);
  EXPECT_FALSE(ParseSegmentationMethod("mog2").has_value());
  EXPECT_FALSE(ParseShadowRule("").has_value());
}

}  // namespace
}  // namespace elbowroom::recon
