// What every kind of live camera shares: clocks, counts, layouts of pixels, messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "core/error.h"
#include "recon/capture/device/camera_protocol.h"
#include "recon/capture/device/device_clock.h"
#include "recon/capture/device/picture_count.h"
#include "recon/capture/device/pixel_layout.h"

namespace elbowroom::recon {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// A camera's clock with an unknown beginning that is fast by 100 ppm, and a way with queues.
TEST(DeviceClock, FollowsADriftingClockThroughQueues) {
  constexpr std::int64_t kBegun = 987'654'321'000, kLeastWay = 3 * kMs;
  constexpr double kFast = 1.0 + 1e-4;
  std::mt19937 random(1);
  std::exponential_distribution<> queue_ms(1.0 / 4.0);
  DeviceClock clock;
  double worst_ms = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t true_ns = 33'333'333LL * i;
    const auto device_ns = kBegun + static_cast<std::int64_t>(static_cast<double>(true_ns) * kFast);
    const auto arrived_ns = true_ns + kLeastWay + static_cast<std::int64_t>(queue_ms(random) * kMs);
    const std::int64_t mapped_ns = clock.OnComputersClock(device_ns, arrived_ns);
    EXPECT_LE(mapped_ns, arrived_ns);
    constexpr int kSettled = 60;
    if (i > kSettled)
      worst_ms = std::max(worst_ms, std::abs(static_cast<double>(mapped_ns - true_ns - kLeastWay)) / kMs);
  }
  // 0.2 ms of drift over the window, and the least of 60 queues: above 1 ms in one of 3 million.
  EXPECT_LT(worst_ms, 1.2);
}

TEST(DeviceClock, TakesAClockThatWasSetAnew) {
  DeviceClock clock;
  for (int i = 0; i < 50; ++i)
    (void)clock.OnComputersClock(1000 * kMs + 33 * kMs * i, 33 * kMs * i + 2 * kMs);
  EXPECT_EQ(clock.OnComputersClock(7 * kMs, 1700 * kMs), 1700 * kMs);
}

TEST(PictureCount, GoesOnWhereTheCameraBeginsAgain) {
  PictureCount count;
  EXPECT_EQ(count.Next(65'534), 65'534U);
  EXPECT_EQ(count.Next(65'535), 65'535U);
  EXPECT_EQ(count.Next(1), 65'536U);
  EXPECT_EQ(count.Next(3), 65'538U);
}

TEST(PictureCount, ALateOneIsNone) {
  PictureCount count;
  (void)count.Next(100);
  EXPECT_EQ(count.Next(98), std::nullopt);
  EXPECT_EQ(count.Next(100), std::nullopt);
  EXPECT_EQ(count.Next(101), 101U);
}

// What a buffer holds whose first packet was lost: nothing yet, or what it held before.
TEST(PictureCount, APictureWithoutANumberIsNone) {
  for (const std::uint64_t first : {std::uint64_t{7}, std::uint64_t{65'010}}) {
    PictureCount count;
    EXPECT_EQ(count.Next(0), std::nullopt);
    EXPECT_EQ(count.Next(first), first);
    EXPECT_EQ(count.Next(0), std::nullopt);
    EXPECT_EQ(count.Next(first + 2), first + 2);
  }
  PictureCount count;
  (void)count.Next(65'534);
  EXPECT_EQ(count.Next(3), 65'538U);
  EXPECT_EQ(count.Next(65'530), std::nullopt);
  EXPECT_EQ(count.Next(4), 65'539U);
}

TEST(PictureCount, CountsIn64Bits) {
  PictureCount count;
  EXPECT_EQ(count.Next(65'535), 65'535U);
  EXPECT_EQ(count.Next(65'536), 65'536U);
  EXPECT_EQ(count.Next(5'000'000'000U), 5'000'000'000U);
  EXPECT_EQ(count.Next(5), std::nullopt);
}

// A plain colour stays what it is in every layout.
TEST(PixelLayout, EveryLayoutGivesItsColour) {
  const cv::Vec3b bgr(40, 90, 200);
  struct Case {
    PixelLayout layout;
    std::vector<unsigned char> two_rows[2];  // two pixels of two rows
  };
  const std::vector<Case> cases{
      {PixelLayout::kBayerRg8, {{200, 90}, {90, 40}}},
      {PixelLayout::kBayerGr8, {{90, 200}, {40, 90}}},
      {PixelLayout::kBayerGb8, {{90, 40}, {200, 90}}},
      {PixelLayout::kBayerBg8, {{40, 90}, {90, 200}}},
      {PixelLayout::kRgb8, {{200, 90, 40, 200, 90, 40}, {200, 90, 40, 200, 90, 40}}},
      {PixelLayout::kBgr8, {{40, 90, 200, 40, 90, 200}, {40, 90, 200, 40, 90, 200}}}};
  constexpr int kWidth = 16, kHeight = 10;
  for (const Case& example : cases) {
    std::vector<std::byte> bytes;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth / 2; ++x)
        for (const unsigned char value : example.two_rows[y % 2]) bytes.push_back(std::byte{value});
    cv::Mat image(kHeight, kWidth, CV_8UC3);
    const unsigned char* memory = image.data;
    ToBgr(bytes, example.layout, {kWidth, kHeight}, BytesPerRow(example.layout, kWidth), image);
    EXPECT_EQ(image.data, memory);
    cv::Mat differs;
    cv::compare(image.reshape(1), cv::Mat(image.size(), CV_8UC3, cv::Scalar(bgr)).reshape(1), differs,
                cv::CMP_NE);
    EXPECT_EQ(cv::countNonZero(differs), 0) << "layout " << static_cast<int>(example.layout);
  }
}

TEST(PixelLayout, GreyAndYuvGiveGrey) {
  constexpr int kWidth = 8, kHeight = 4;
  cv::Mat image;
  ToBgr(std::vector<std::byte>(kWidth * kHeight, std::byte{77}), PixelLayout::kMono8, {kWidth, kHeight},
        kWidth, image);
  EXPECT_EQ(image.at<cv::Vec3b>(3, 7), cv::Vec3b(77, 77, 77));
  std::vector<std::byte> yuyv;
  for (int i = 0; i < kWidth * kHeight; ++i) yuyv.insert(yuyv.end(), {std::byte{126}, std::byte{128}});
  ToBgr(yuyv, PixelLayout::kYuyv, {kWidth, kHeight}, 2 * kWidth, image);
  EXPECT_EQ(image.at<cv::Vec3b>(1, 1), cv::Vec3b(128, 128, 128));  // (126 - 16) * 255 / 219
}

TEST(PixelLayout, TooFewBytesAreRefused) {
  cv::Mat image;
  EXPECT_THROW(ToBgr(std::vector<std::byte>(31), PixelLayout::kMono8, {8, 4}, 8, image),
               core::PreconditionError);
  EXPECT_THROW(ToBgr(std::vector<std::byte>(32), PixelLayout::kMono8, {8, 4}, 7, image),
               core::PreconditionError);
}

TEST(CameraProtocol, RequestsAndReportsComeBackAsTheyWere) {
  DeviceRequest request{"gige:10.0.0.7", 640, 480, {}};
  request.settings.exposure_us = 8000.0;
  request.settings.trigger = CaptureTrigger::kHardware;
  request.settings.pixel_format = "BayerRG8";
  request.settings.packet_bytes = 9000;
  const DeviceRequest back = RequestOf(OrderFor(request), request.location);
  EXPECT_EQ(back.location, request.location);
  EXPECT_EQ(back.settings, request.settings);
  EXPECT_EQ(back.width_px, 640);
  EXPECT_EQ(back.height_px, 480);
  const DeviceReport report{"Fake (GV01)", 30.0, {}, 3.5, {}, {"one", "two"}};
  const DeviceReport told = ReportOf(NewsOf(report), TextOf(report));
  EXPECT_EQ(told.name, report.name);
  EXPECT_EQ(told.rate_hz, 30.0);
  EXPECT_EQ(told.exposure_us, std::nullopt);
  EXPECT_EQ(told.gain_db, 3.5);
  EXPECT_EQ(told.warnings, report.warnings);
}

}  // namespace
}  // namespace elbowroom::recon
