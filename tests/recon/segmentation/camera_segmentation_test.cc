// What differs for single cameras: thresholds of their own, and pixels that are ignored.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>
#include <string>

#include "core/error.h"
#include "recon/segmentation/frame_segmenter.h"
#include "recon/segmentation/ignored_pixels.h"
#include "recon/segmentation/segmentation.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::HasSubstr;

core::BitMask BoxMask(const cv::Size& size, const cv::Rect& box) {
  core::BitMask mask(size.width, size.height);
  for (int y = box.y; y < box.br().y; ++y)
    for (int x = box.x; x < box.br().x; ++x) mask.Set(x, y, true);
  return mask;
}

BackgroundReference GreyBackground(const cv::Size& size) {
  return {cv::Mat(size, CV_32FC3, cv::Scalar::all(100)), cv::Mat(size, CV_32FC3, cv::Scalar::all(1.0)), 30};
}

TEST(IgnoredPixels, AreNeverObjectWhateverTheMethod) {
  const cv::Size size(200, 90);
  const core::BitMask ignore = BoxMask(size, {60, 20, 50, 40});
  cv::Mat picture(size, CV_8UC3, cv::Scalar::all(100));
  picture(cv::Rect(30, 10, 60, 60)).setTo(cv::Scalar(20, 20, 250));  // a part of it is ignored
  picture(cv::Rect(100, 25, 8, 8)).setTo(cv::Scalar::all(255));      // clipped, in the ignored box
  for (const SegmentationMethod method : {SegmentationMethod::kThreshold, SegmentationMethod::kAdaptive}) {
    for (const double gain : {0.6, 1.0, 1.4}) {
      SegmentationOptions options;
      options.method = method;
      if (method == SegmentationMethod::kThreshold && gain != 1.0) continue;
      cv::Mat lit;
      picture.convertTo(lit, CV_8U, gain);
      lit(cv::Rect(100, 25, 8, 8)).setTo(cv::Scalar::all(255));
      const core::SoftMask soft = Segmenter(GreyBackground(size), options, ignore).SegmentSoft(lit);
      soft.Validate();
      const core::SoftMask open = Segmenter(GreyBackground(size), options).SegmentSoft(lit);
      std::size_t ignored_object = 0;
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          EXPECT_FALSE(soft.mask.At(x, y) && ignore.At(x, y)) << x << ' ' << y;
          ignored_object += open.mask.At(x, y) && ignore.At(x, y) ? 1 : 0;
        }
      }
      EXPECT_EQ(ignored_object, 40U * 30U) << "without the mask they are object";
      EXPECT_EQ(soft.mask.CountObjectPixels(), 60U * 60U - 40U * 30U);
    }
  }
}

// Pixel by pixel, from the mask's definition.
TEST(IgnoredPixels, KeepTheLevelsOfTheBoundaryThatStays) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial) {
    core::SoftMask soft{core::BitMask(70, 20), {}};
    core::BitMask ignore(70, 20);
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 70; ++x) {
        soft.mask.Set(x, y, random() % 3 != 0);
        ignore.Set(x, y, random() % 4 == 0);
      }
    }
    const core::BitMask before = core::BoundaryPixels(soft.mask);
    cv::Mat level(20, 70, CV_8U, cv::Scalar(0));
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 70; ++x) {
        if (!before.At(x, y)) continue;
        level.at<std::uint8_t>(y, x) =
            static_cast<std::uint8_t>(soft.mask.At(x, y) ? 128 + random() % 128 : random() % 128);
        soft.levels.push_back(level.at<std::uint8_t>(y, x));
      }
    }
    const core::SoftMask left = WithoutPixels(soft, ignore);
    left.Validate();
    const core::BitMask after = core::BoundaryPixels(left.mask);
    auto next = left.levels.begin();
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 70; ++x) {
        ASSERT_EQ(left.mask.At(x, y), soft.mask.At(x, y) && !ignore.At(x, y));
        if (!after.At(x, y)) continue;
        const bool keeps = before.At(x, y) && left.mask.At(x, y) == soft.mask.At(x, y);
        const int halfway = left.mask.At(x, y) ? 191 : 64;
        ASSERT_EQ(int{*next++}, keeps ? int{level.at<std::uint8_t>(y, x)} : halfway) << x << ' ' << y;
      }
    }
  }
  EXPECT_TRUE(WithoutPixels({BoxMask({9, 9}, {1, 1, 3, 3}), {}}, core::BitMask(9, 9)).levels.empty());
}

TEST(CameraSegmentation, GivesACameraItsOwnThresholdsAndMask) {
  const core::Rig rig = FourCameraRig();
  const cv::Size size(rig.cameras[0].width_px(), rig.cameras[0].height_px());
  SegmentationOptions options;
  options.cameras = {{rig.cameras[1].name(), std::nullopt, 50.0, {}},
                     {rig.cameras[2].name(), 60.0, std::nullopt, {}},
                     {rig.cameras[3].name(), std::nullopt, std::nullopt, BoxMask(size, {0, 0, 640, 480})}};
  EXPECT_EQ(options.ForCamera(rig.cameras[1].name()).floor_levels, 50.0);
  EXPECT_EQ(options.ForCamera(rig.cameras[1].name()).k_sigma, options.k_sigma);
  EXPECT_EQ(options.ForCamera(rig.cameras[2].name()).k_sigma, 60.0);
  EXPECT_EQ(options.OfCamera(rig.cameras[0].name()), nullptr);
  FrameSet frames;
  for (int i = 0; i < 4; ++i) {
    frames.cameras.push_back({cv::Mat(size, CV_8UC3, cv::Scalar::all(100)), std::nullopt});
    frames.cameras.back().image_bgr(cv::Rect(200, 100, 240, 280)).setTo(cv::Scalar::all(140));
  }
  const std::vector<BackgroundReference> backgrounds(4, GreyBackground(size));
  std::vector<core::BitMask> masks = FrameSegmenter(backgrounds, options, rig).Segment(frames);
  EXPECT_EQ(masks[1].CountObjectPixels() + masks[2].CountObjectPixels() + masks[3].CountObjectPixels(), 0U);
  options.cameras.clear();
  masks = FrameSegmenter(backgrounds, options, rig).Segment(frames);
  for (const core::BitMask& mask : masks) EXPECT_GT(mask.CountObjectPixels(), 1000U);
}

TEST(CameraSegmentation, NamesWhatIsWrongInOneLine) {
  const core::Rig rig = FourCameraRig();
  const std::string name = rig.cameras[0].name();
  const auto message = [&](std::vector<CameraSegmentation> cameras) {
    SegmentationOptions options;
    options.cameras = std::move(cameras);
    return testing::ErrorOf(ErrorKind::kRange, [&] { options.Validate(rig); });
  };
  EXPECT_THAT(message({{"camera9", 4.0, std::nullopt, {}}}), HasSubstr("'camera9' isn't in the rig"));
  EXPECT_THAT(message({{"camera9", 4.0, std::nullopt, {}}}), HasSubstr("'" + name + "'"));
  EXPECT_THAT(message({{name, std::nullopt, std::nullopt, core::BitMask(64, 48)}}),
              HasSubstr("64 x 48 pixels, but its pictures have 640 x 480"));
  EXPECT_THAT(message({{name, -1.0, std::nullopt, {}}}), HasSubstr("k_sigma"));
  EXPECT_THAT(message({{name, std::nullopt, 300.0, {}}}), HasSubstr("floor_levels"));
  EXPECT_THAT(message({{name, 1.0, std::nullopt, {}}, {name, 2.0, std::nullopt, {}}}), HasSubstr("twice"));
}

}  // namespace
}  // namespace elbowroom::recon
