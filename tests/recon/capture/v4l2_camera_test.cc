// A webcam behind the calls of Linux, with a driver that the test plays.
#include "recon/capture/v4l2/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <utility>
#include <vector>

#include "core/error.h"
#include "tests/recon/capture/played_driver.h"
#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::ElementsAre;
using testing::ErrorOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kHeightPx;
using testing::kWidthPx;
using testing::NumberedPicture;
using testing::NumberIn;
using testing::PlayedDriver;
using testing::PlayedPicture;
using testing::PlayedWebcam;

constexpr std::chrono::milliseconds kWait{1};

std::vector<std::byte> JpegOf(int number) {
  std::vector<unsigned char> file;
  cv::imencode(".jpg", NumberedPicture(number), file);
  std::vector<std::byte> bytes(file.size());
  std::ranges::transform(file, bytes.begin(), [](unsigned char c) { return std::byte{c}; });
  return bytes;
}

std::vector<std::byte> GreyYuyv(unsigned char level) {
  std::vector<std::byte> bytes;
  for (int i = 0; i < kWidthPx * kHeightPx; ++i)
    bytes.insert(bytes.end(), {std::byte{level}, std::byte{128}});
  return bytes;
}

class V4l2 : public ::testing::Test {
 protected:
  V4l2() {
    webcam_.most_rate_hz = {{V4L2_PIX_FMT_YUYV, 30.0}, {V4L2_PIX_FMT_MJPEG, 60.0}};
    webcam_.width = kWidthPx;
    webcam_.height = kHeightPx;
    webcam_.controls = {{V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY},
                        {V4L2_CID_EXPOSURE_ABSOLUTE, 300},
                        {V4L2_CID_AUTO_WHITE_BALANCE, 1},
                        {V4L2_CID_WHITE_BALANCE_TEMPERATURE, 4000}};
    request_ = {"v4l2:/dev/video0", kWidthPx, kHeightPx, {}};
    request_.settings.rate_hz = 30.0;
  }

  [[nodiscard]] std::unique_ptr<CameraDevice> Open() {
    return MakeV4l2Camera(request_, std::make_unique<PlayedDriver>(webcam_));
  }

  PlayedWebcam webcam_;
  DeviceRequest request_;
  cv::Mat image_ = cv::Mat(kHeightPx, kWidthPx, CV_8UC3);
};

TEST_F(V4l2, PlainPicturesAreTakenWhereTheyAreFastEnough) {
  webcam_.pictures = {{GreyYuyv(126), 0, 5'000'000}};
  const auto camera = Open();
  EXPECT_EQ(webcam_.format, V4L2_PIX_FMT_YUYV);
  EXPECT_EQ(camera->report().rate_hz, 30.0);
  EXPECT_EQ(camera->report().name, "Played webcam");
  const auto picture = camera->Next(kWait, image_);
  ASSERT_TRUE(picture.has_value());
  EXPECT_EQ(picture->state, PictureState::kWhole);
  EXPECT_EQ(image_.at<cv::Vec3b>(10, 10), cv::Vec3b(128, 128, 128));
}

TEST_F(V4l2, JpegIsTakenWhereThatIsFaster) {
  request_.settings.rate_hz = 60.0;
  webcam_.pictures = {{JpegOf(123), 0, 5'000'000}};
  const auto camera = Open();
  EXPECT_EQ(webcam_.format, V4L2_PIX_FMT_MJPEG);
  EXPECT_EQ(camera->report().rate_hz, 60.0);
  ASSERT_TRUE(camera->Next(kWait, image_).has_value());
  EXPECT_EQ(NumberIn(image_), 123);
}

TEST_F(V4l2, SettingsAreMadeByHandAndReadBack) {
  request_.settings.exposure_us = 8000.0;
  request_.settings.white_balance_k = 5200.0;
  const auto camera = Open();
  EXPECT_EQ(webcam_.controls[V4L2_CID_EXPOSURE_AUTO], V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(webcam_.controls[V4L2_CID_EXPOSURE_ABSOLUTE], 80);
  EXPECT_EQ(webcam_.controls[V4L2_CID_AUTO_WHITE_BALANCE], 0);
  EXPECT_EQ(camera->report().exposure_us, 8000.0);
  EXPECT_EQ(camera->report().white_balance_k, 5200.0);
  EXPECT_EQ(camera->report().gain_db, std::nullopt);
  EXPECT_THAT(camera->report().warnings, IsEmpty());
}

TEST_F(V4l2, WhatTheCameraCantDoIsAWarning) {
  request_.settings.exposure_us = 50'000.0;
  request_.settings.gain_db = 6.0;
  request_.settings.rate_hz = 90.0;
  webcam_.most[V4L2_CID_EXPOSURE_ABSOLUTE] = 330;
  const auto camera = Open();
  EXPECT_THAT(camera->report().warnings,
              ElementsAre("rate_hz is 60, not 90", "exposure_us is 33000, not 50000",
                          "gain_db 6 is refused by the driver"));
}

TEST_F(V4l2, StampsAreOfTheMiddleOfTheExposure) {
  request_.settings.exposure_us = 8000.0;
  webcam_.pictures = {{GreyYuyv(100), 0, 5'000'000, V4L2_BUF_FLAG_TSTAMP_SRC_SOE},
                      {GreyYuyv(100), 1, 5'033'000}};
  const auto camera = Open();
  EXPECT_EQ(camera->Next(kWait, image_)->taken_ns, 5'004'000'000);
  const auto at_end = camera->Next(kWait, image_);
  EXPECT_EQ(at_end->taken_ns, 5'029'000'000);
  EXPECT_EQ(at_end->stamp_source, StampSource::kDriver);
}

TEST_F(V4l2, NumbersAreTheDrivers) {
  constexpr std::uint32_t kLast = 0xFFFFFFFF;
  webcam_.pictures = {{GreyYuyv(1), kLast - 1, 1}, {GreyYuyv(1), kLast, 2}, {GreyYuyv(1), 2, 3}};
  const auto camera = Open();
  const std::uint64_t first = camera->Next(kWait, image_)->number;
  EXPECT_EQ(camera->Next(kWait, image_)->number, first + 1);
  EXPECT_EQ(camera->Next(kWait, image_)->number, first + 4);  // 0 and 1 are missing
}

TEST_F(V4l2, DamagedPicturesAreTold) {
  request_.settings.pixel_format = "MJPG";
  std::vector<std::byte> cut = JpegOf(7);
  cut.resize(cut.size() / 2);
  std::vector<std::byte> large;
  std::vector<unsigned char> file;
  cv::imencode(".jpg", NumberedPicture(7, 2 * kWidthPx, kHeightPx), file);
  std::ranges::transform(file, std::back_inserter(large), [](unsigned char c) { return std::byte{c}; });
  webcam_.pictures = {
      {cut, 0, 1}, {{}, 1, 2}, {large, 2, 3}, {JpegOf(8), 3, 4, V4L2_BUF_FLAG_ERROR}, {JpegOf(9), 4, 5}};
  const auto camera = Open();
  for (int i = 0; i < 4; ++i) EXPECT_EQ(camera->Next(kWait, image_)->state, PictureState::kDamaged) << i;
  EXPECT_EQ(camera->Next(kWait, image_)->state, PictureState::kWhole);
  EXPECT_EQ(NumberIn(image_), 9);
  EXPECT_EQ(webcam_.buffers_out, 4);  // every buffer went back
}

TEST_F(V4l2, AShortPlainPictureIsIncomplete) {
  std::vector<std::byte> bytes = GreyYuyv(50);
  bytes.resize(bytes.size() - 2);
  webcam_.pictures = {{bytes, 0, 1}};
  EXPECT_EQ(Open()->Next(kWait, image_)->state, PictureState::kIncomplete);
}

TEST_F(V4l2, AnotherSizeIsRefused) {
  request_.width_px = 640;
  EXPECT_THAT(ErrorOf(ErrorKind::kCamera, [&] { (void)Open(); }),
              HasSubstr("gives 96 x 64 px, but it was calibrated with 640 x 64"));
}

TEST_F(V4l2, ACameraThatIsPulledOutIsGone) {
  const auto camera = Open();
  EXPECT_THAT(ErrorOf(ErrorKind::kCamera, [&] { (void)camera->Next(kWait, image_); }), HasSubstr("is gone"));
}

TEST_F(V4l2, ADeviceThatIsntThereIsNamed) {
  request_.location = "v4l2:/dev/video987";
  EXPECT_THAT(ErrorOf(ErrorKind::kCamera, [&] { (void)OpenV4l2Camera(request_); }),
              HasSubstr("'v4l2:/dev/video987' can't be opened (No such file or directory)"));
}

TEST_F(V4l2, TheStreamEndsWithTheCamera) {
  Open().reset();
  EXPECT_FALSE(webcam_.is_streaming);
}

}  // namespace
}  // namespace elbowroom::recon
