#include "recon/images/mask_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::AllOf;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::TestFolder;

core::BitMask RandomMask(int width_px, int height_px, std::uint32_t seed) {
  std::mt19937 random(seed);
  core::BitMask mask(width_px, height_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) mask.Set(x, y, (random() & 1U) != 0);
  }
  return mask;
}

TEST(MaskImage, ComesBackFromAPngAtEveryWidthAroundAWord) {
  const TestFolder folder;
  for (const int width_px : {1, 63, 64, 65, 127, 128, 200}) {
    const core::BitMask mask = RandomMask(width_px, 7, 1U + static_cast<std::uint32_t>(width_px));
    EXPECT_EQ(MaskFromImage(ImageFromMask(mask)), mask) << width_px;
    WriteMaskPng(mask, folder.path() / "mask.png");
    EXPECT_EQ(ReadMaskImage(folder.path() / "mask.png", "camera 'a'"), mask) << width_px;
  }
}

TEST(MaskImage, TakesAnyNonZeroChannelButAlphaAsObject) {
  cv::Mat colour(1, 3, CV_8UC3, cv::Scalar(0, 0, 0));
  colour.at<cv::Vec3b>(0, 1) = {0, 0, 1};
  cv::Mat with_alpha(1, 3, CV_8UC4, cv::Scalar(0, 0, 0, 255));
  with_alpha.at<cv::Vec4b>(0, 1) = {0, 9, 0, 0};
  cv::Mat deep(1, 3, CV_16U, cv::Scalar(0));
  deep.at<std::uint16_t>(0, 1) = 256;  // its low byte is zero
  for (const cv::Mat& image : {colour, with_alpha, deep}) {
    const core::BitMask mask = MaskFromImage(image);
    EXPECT_TRUE(mask.At(1, 0));
    EXPECT_EQ(mask.CountObjectPixels(), 1U);
  }
}

TEST(MaskImage, SaysWhatIsWrongWithAFile) {
  const TestFolder folder;
  const auto read = [&](const std::string& name, ErrorKind kind) {
    return ErrorOf(kind, [&] { (void)ReadMaskImage(folder.path() / name, "camera 'cam7'"); });
  };
  EXPECT_THAT(read("none.png", ErrorKind::kFile),
              AllOf(HasSubstr("cam7"), HasSubstr("none.png"), HasSubstr("exist")));
  testing::WriteText(folder.path() / "empty.png", "");
  EXPECT_THAT(read("empty.png", ErrorKind::kFile), HasSubstr("is empty"));
  testing::WriteText(folder.path() / "text.png", "this is no picture");
  EXPECT_THAT(read("text.png", ErrorKind::kFile), HasSubstr("can't be decoded"));
  WriteMaskPng(RandomMask(80, 60, 3), folder.path() / "whole.png");
  for (const double share : {0.01, 0.3, 0.6, 0.95, 0.999}) {
    testing::CutFile(folder.path() / "whole.png", folder.path() / "cut.png", share);
    EXPECT_THAT(read("cut.png", ErrorKind::kFile), AllOf(HasSubstr("cut.png"), HasSubstr("cam7"))) << share;
  }
  std::fstream whole(folder.path() / "whole.png", std::ios::in | std::ios::out | std::ios::binary);
  whole.seekp(static_cast<std::streamoff>(std::filesystem::file_size(folder.path() / "whole.png") / 2));
  whole.write("damage", 6);
  whole.close();
  EXPECT_THAT(read("whole.png", ErrorKind::kFile), HasSubstr("is damaged"));
  cv::imwrite(folder.File("mask.jpg"), ImageFromMask(RandomMask(80, 60, 3)));
  EXPECT_THAT(read("mask.jpg", ErrorKind::kFormat), HasSubstr("JPEG"));
  testing::CutFile(folder.path() / "mask.jpg", folder.path() / "cut.jpg", 0.7);
  EXPECT_THAT(read("cut.jpg", ErrorKind::kFile), HasSubstr("cut short"));
}

TEST(MaskImage, LeavesNothingBehindWhereItCannotWrite) {
  const TestFolder folder;
  std::filesystem::create_directories(folder.path() / "taken.png" / "inside");
  const core::BitMask mask = RandomMask(8, 8, 1);
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { WriteMaskPng(mask, folder.path() / "taken.png"); }),
              HasSubstr("taken.png"));
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { WriteMaskPng(mask, folder.path() / "no" / "mask.png"); }),
              HasSubstr("no/mask.png"));
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++entries;
  EXPECT_EQ(entries, 1);
}

}  // namespace
}  // namespace elbowroom::recon
