#include "recon/images/png_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

namespace fs = std::filesystem;

class WritePngTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::size_t FilesInFolder() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) / ("elbowroom_png_" + std::to_string(::getpid()) + "_" +
                                        ::testing::UnitTest::GetInstance()->current_test_info()->name());
  const Image image_{3, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30, 40, 50, 60, 70, 80, 90}};
};

TEST_F(WritePngTest, ReadsBackPixelForPixel) {
  WritePng(image_, folder_ / "a.png");
  const cv::Mat bgr = cv::imread((folder_ / "a.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(bgr.type(), CV_8UC3);
  ASSERT_EQ(bgr.cols, 3);
  ASSERT_EQ(bgr.rows, 2);
  for (int i = 0; i < 6; ++i) {
    const auto& pixel = bgr.at<cv::Vec3b>(i / 3, i % 3);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_EQ(pixel[2 - channel], image_.rgb[static_cast<std::size_t>(3 * i + channel)]);
    }
  }
  EXPECT_EQ(FilesInFolder(), 1U);
}

TEST_F(WritePngTest, ReplacesAnOlderPicture) {
  WritePng(image_, folder_ / "a.png");
  WritePng({1, 1, {1, 2, 3}}, folder_ / "a.png");
  EXPECT_EQ(cv::imread((folder_ / "a.png").string()).cols, 1);
  EXPECT_EQ(FilesInFolder(), 1U);
}

TEST_F(WritePngTest, MissingFolderIsAnErrorThatNamesThePath) {
  const fs::path path = folder_ / "missing" / "a.png";
  try {
    WritePng(image_, path);
    FAIL() << "nothing was thrown";
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::ErrorKind::kFile);
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
}

TEST_F(WritePngTest, PathThatIsAFolderLeavesNothingBehind) {
  fs::create_directories(folder_ / "taken.png" / "inside");
  EXPECT_THROW(WritePng(image_, folder_ / "taken.png"), core::Error);
  EXPECT_EQ(FilesInFolder(), 1U);
}

TEST_F(WritePngTest, BytesThatDoNotMatchTheSizeAreABug) {
  EXPECT_THROW((void)EncodePng({2, 2, {1, 2, 3}}), core::PreconditionError);
  EXPECT_THROW((void)EncodePng({}), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
