#include "recon/segmentation/mask_regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "recon/images/mask_image.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

// The slow way: OpenCV's components of the whole picture.
cv::Mat WithoutSmall(const cv::Mat& object, bool value, int least_px, int connectivity) {
  cv::Mat labels, stats, centroids, changed = object.clone();
  const cv::Mat region = value ? object : cv::Mat(object == 0);
  const int count = cv::connectedComponentsWithStats(region, labels, stats, centroids, connectivity, CV_32S);
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < least_px) changed.setTo(value ? 0 : 255, labels == i);
  }
  return changed;
}

// Blots of many sizes, most of them under noise: regions within regions, along the picture's edges, over word
// borders, and columns without any.
cv::Mat RandomPicture(std::mt19937& random) {
  cv::Mat object(1 + static_cast<int>(random() % 60U), 1 + static_cast<int>(random() % 200U), CV_8U,
                 cv::Scalar(0));
  const auto within = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  const bool is_noisy = random() % 4U != 0;
  for (int i = 0; i < (is_noisy ? 8 : 2); ++i) {
    cv::circle(object, {within(object.cols), within(object.rows)}, within(20),
               cv::Scalar(i % 3 == 2 ? 0 : 255), -1);
  }
  const auto noise = 2U + random() % 40U;
  for (int i = 0; is_noisy && i < object.rows * object.cols; ++i) {
    if (random() % noise == 0) object.data[i] = static_cast<std::uint8_t>(~object.data[i]);
  }
  return object;
}

TEST(MaskRegions, AreThoseOfASlowLabelling) {
  std::mt19937 random(7);
  for (int i = 0; i < 300 * test_support::SoakScale(); ++i) {
    const cv::Mat object = RandomPicture(random);
    const int least_px = static_cast<int>(random() % 150U);
    core::BitMask mask = MaskFromImage(object);
    cv::Mat labels;
    ASSERT_EQ(ObjectRegions(mask).area_px.size(),
              static_cast<std::size_t>(cv::connectedComponents(object, labels, 8) - 1));
    RemoveSmallBlobs(mask, least_px);
    const cv::Mat without_blobs = WithoutSmall(object, true, least_px, 8);
    ASSERT_EQ(mask, MaskFromImage(without_blobs)) << "picture " << i << ", blobs below " << least_px;
    FillSmallHoles(mask, least_px);
    // A picture without an object has nothing to fill.
    const cv::Mat wanted = cv::countNonZero(without_blobs) == 0
                               ? without_blobs
                               : WithoutSmall(without_blobs, false, least_px, 4);
    ASSERT_EQ(mask, MaskFromImage(wanted)) << "picture " << i << ", holes below " << least_px;
    core::BitMask at_once = MaskFromImage(object);
    CleanUp(at_once, least_px, least_px);
    ASSERT_EQ(at_once, mask) << "picture " << i;
  }
}

TEST(MaskRegions, OfASmallBlobLeaveItsSurroundingsAlone) {
  core::BitMask mask(90, 70);
  for (int y = 30; y < 32; ++y)
    for (int x = 60; x < 70; ++x) mask.Set(x, y, true);
  const core::BitMask before = mask;
  FillSmallHoles(mask, 100);  // the ring of background around it is smaller than that
  EXPECT_EQ(mask, before);
}

TEST(MaskRegions, KnowTheirAreaAndAreClearedOnRequest) {
  core::BitMask mask(130, 4);
  for (int x = 60; x < 70; ++x) mask.Set(x, 1, true);
  mask.Set(70, 2, true);   // by a corner
  mask.Set(129, 3, true);  // alone
  const Regions regions = ObjectRegions(mask);
  EXPECT_EQ(regions.area_px, (std::vector<std::int64_t>{11, 1}));
  ClearRegions(mask, regions, {false, true});
  EXPECT_EQ(mask.CountObjectPixels(), 1U);
  EXPECT_TRUE(mask.At(129, 3));
}

}  // namespace
}  // namespace elbowroom::recon
