#include "recon/recording/video_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "recon/footage/image_source.h"
#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::PlainCamera;
using testing::TestFolder;

// Every value of every pixel is as likely as any other: nothing that a codec could guess.
cv::Mat NoisePicture(cv::Size size_px, std::uint64_t seed) {
  cv::Mat picture(size_px, CV_8UC3);
  cv::RNG(seed + 1).fill(picture, cv::RNG::UNIFORM, 0, 256);
  return picture;
}

class LosslessVideo : public ::testing::TestWithParam<cv::Size> {};

TEST_P(LosslessVideo, ReadsBackBitForBit) {
  const TestFolder folder;
  const cv::Size size_px = GetParam();
  constexpr int kFrames = 25;
  VideoWriter writer(folder.File("v.avi"), size_px, 29.97);
  for (int i = 0; i < kFrames; ++i) writer.Write(NoisePicture(size_px, static_cast<std::uint64_t>(i)));
  writer.Finish();
  const auto source =
      OpenImageSource(folder.File("v.avi"), PlainCamera("cam1", size_px.width, size_px.height), {});
  EXPECT_EQ(source->frame_count(), kFrames);
  constexpr double kRoundedHz = 0.01;  // the container holds a fraction
  EXPECT_NEAR(source->frame_rate_hz().value(), 29.97, kRoundedHz);
  for (int i = 0; i < kFrames; ++i) {
    const auto picture = source->Read(i, {});
    ASSERT_TRUE(picture.has_value()) << i;
    EXPECT_EQ(
        cv::norm(picture->image_bgr, NoisePicture(size_px, static_cast<std::uint64_t>(i)), cv::NORM_INF), 0.0)
        << i;
  }
  EXPECT_FALSE(source->Read(kFrames, {}).has_value());
}

// Rows whose bytes are and aren't a multiple of four, the least size, odd sides.
INSTANTIATE_TEST_SUITE_P(Sizes, LosslessVideo,
                         ::testing::Values(cv::Size(640, 480), cv::Size(645, 487), cv::Size(16, 16),
                                           cv::Size(98, 17)));

TEST(VideoWriter, SaysThatTheDiskIsFull) {
  VideoWriter writer("/dev/full", {640, 480}, 30.0);
  const auto write = [&] {
    for (int i = 0; i < 30; ++i) writer.Write(NoisePicture({640, 480}, 1));
    writer.Finish();
  };
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, write), HasSubstr("video '/dev/full': the disk is full"));
}

TEST(VideoWriter, SaysWhatCantBeWritten) {
  const TestFolder folder;
  const auto write = [&](const std::string& path, cv::Size size_px) {
    return ErrorOf(ErrorKind::kFile, [&] {
      VideoWriter writer(path, size_px, 30.0);
      writer.Write(cv::Mat(size_px, CV_8UC3));
      writer.Finish();
    });
  };
  EXPECT_THAT(write(folder.File("none/v.avi"), {64, 64}), HasSubstr("Could not open file"));
  EXPECT_THAT(write(folder.File("v.avi"), {4100, 64}), HasSubstr("4100 x 64 px can't be recorded"));
}

}  // namespace
}  // namespace elbowroom::recon
