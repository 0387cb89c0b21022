// Pictures and videos that lie, are damaged, or are none: each ends as one line, and the next is read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <vector>

#include "recon/footage/image_source.h"
#include "recon/images/image_file.h"
#include "recon/images/mask_image.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::AllOf;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::NumberedPicture;
using testing::NumberIn;
using testing::PlainCamera;
using testing::TestFolder;

std::string Encoded(const cv::Mat& image, const std::string& extension, const std::vector<int>& how = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes, how);
  return {bytes.begin(), bytes.end()};
}

// A picture whose every block differs, so that what is lost shows.
cv::Mat Noise() {
  cv::Mat noise(testing::kHeightPx, testing::kWidthPx, CV_8UC3);
  std::mt19937 random(5);
  for (int y = 0; y < noise.rows; ++y)
    for (int x = 0; x < 3 * noise.cols; ++x) noise.ptr(y)[x] = static_cast<unsigned char>(random() % 256U);
  return noise;
}

class DamagedPicture : public ::testing::Test {
 protected:
  // What reading that file as camera cam3's only frame says.
  [[nodiscard]] std::string ErrorOfFrame(const std::string& name, const std::string& bytes) const {
    test_support::WriteText(folder_.path() / name, bytes);
    return ErrorOfFrame(name);
  }
  [[nodiscard]] std::string ErrorOfFrame(const std::string& name) const {
    const auto source = OpenImageSource(folder_.File(name), PlainCamera("cam3"));
    return ErrorOf(ErrorKind::kFile, [&] { (void)source->Read(0); });
  }
  [[nodiscard]] cv::Mat FrameOf(const std::string& name, const std::string& bytes) const {
    test_support::WriteText(folder_.path() / name, bytes);
    return OpenImageSource(folder_.File(name), PlainCamera("cam3"))->Read(0).value().image_bgr;
  }
  [[nodiscard]] std::string ErrorOfVideo(const std::string& name, const std::string& bytes) const {
    test_support::WriteText(folder_.path() / name, bytes);
    return ErrorOf(ErrorKind::kFile, [&] {
      const auto source = OpenImageSource(folder_.File(name), PlainCamera("cam3"));
      for (core::FrameIndex i = 0; source->Read(i).has_value(); ++i) {
      }
    });
  }

  TestFolder folder_;
};

TEST_F(DamagedPicture, ACodecsWarningIsAnError) {
  std::string jpeg = Encoded(Noise(), ".jpg");
  jpeg.replace(jpeg.size() / 2, 40, 40, '\x55');
  EXPECT_THAT(ErrorOfFrame("a.jpg", jpeg),
              AllOf(HasSubstr("cam3"), HasSubstr("a.jpg"), HasSubstr("is damaged: Corrupt JPEG data")));
  std::string tiff = Encoded(Noise(), ".tiff");  // LZW
  tiff.replace(tiff.size() / 2, 40, 40, '\xff');
  EXPECT_THAT(ErrorOfFrame("a.tiff", tiff), AllOf(HasSubstr("cam3"), HasSubstr("a.tiff")));
}

TEST_F(DamagedPicture, AJpegThatEndsTooEarlyIsNeverTaken) {
  const std::string jpeg = Encoded(Noise(), ".jpg");
  for (const double share : {0.2, 0.5, 0.8, 0.97}) {
    std::string cut = jpeg.substr(0, static_cast<std::size_t>(share * static_cast<double>(jpeg.size())));
    EXPECT_THAT(ErrorOfFrame("cut.jpg", cut + "\xff\xd9"), HasSubstr("cut.jpg")) << share;
    EXPECT_THAT(ErrorOfFrame("hidden.jpg", cut + std::string("\xff\xe1\x40\x00", 4) + "\xff\xd9"),
                HasSubstr("hidden.jpg"))
        << share;
  }
}

TEST_F(DamagedPicture, NeverShowsThePictureBefore) {
  const std::string jpeg = Encoded(NumberedPicture(5), ".jpg");
  std::string bogus = jpeg;
  bogus[bogus.find("\xff\xc0") + 11] = '\0';  // sampling factors that libjpeg refuses without a word
  test_support::WriteText(folder_.path() / "f_0.jpg", jpeg);
  test_support::WriteText(folder_.path() / "f_1.jpg", bogus);
  const auto source = OpenImageSource(folder_.File("f_%d.jpg"), PlainCamera("cam3"));
  EXPECT_EQ(NumberIn(source->Read(0).value().image_bgr), 5);
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)source->Read(1); }),
              AllOf(HasSubstr("f_1.jpg"), HasSubstr("can't be decoded;")));
  EXPECT_EQ(NumberIn(source->Read(0).value().image_bgr), 5);
}

TEST_F(DamagedPicture, SoundPicturesOfEveryKindAreTaken) {
  const cv::Mat picture = NumberedPicture(77);
  const std::string jpeg = Encoded(picture, ".jpg");
  for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
           {"a.png", Encoded(picture, ".png")},
           {"a.jpg", jpeg},
           {"padded.jpg", jpeg + std::string(600, '\0')},
           {"film.jpg", jpeg + std::string(50'000, 'f')},
           {"progressive.jpg", Encoded(picture, ".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1})},
           {"restarts.jpg", Encoded(picture, ".jpg", {cv::IMWRITE_JPEG_RST_INTERVAL, 2})},
           {"a.bmp", Encoded(picture, ".bmp")},
           {"lzw.tiff", Encoded(picture, ".tiff")},
           {"plain.tiff", Encoded(picture, ".tiff", {cv::IMWRITE_TIFF_COMPRESSION, 1})},
           {"deflate.tiff", Encoded(picture, ".tiff", {cv::IMWRITE_TIFF_COMPRESSION, 8})},
           {"a.ppm", Encoded(picture, ".ppm")}}) {
    EXPECT_EQ(NumberIn(FrameOf(name, bytes)), 77) << name;
  }
}

TEST_F(DamagedPicture, OfAnotherSizeIsRefusedBeforeItIsDecoded) {
  // 48 KB that claim 32,000 x 32,000 pixels: 3 GB, and most of a minute.
  std::string jpeg = Encoded(NumberedPicture(1), ".jpg");
  const std::size_t frame = jpeg.find("\xff\xc0");
  jpeg.replace(frame + 5, 4, "\x7d\x00\x7d\x00", 4);
  jpeg.insert(jpeg.size() - 2, 48'000, '\x11');
  EXPECT_THAT(ErrorOfFrame("bomb.jpg", jpeg),
              AllOf(HasSubstr("cam3"), HasSubstr("is 32000 x 32000 px, but the rig says 96 x 64")));
}

TEST_F(DamagedPicture, OnlyWholeNumbersOfFewBitsArePictures) {
  const cv::Mat levels(testing::kHeightPx, testing::kWidthPx, CV_32FC1, cv::Scalar(0.3));
  EXPECT_THAT(ErrorOfFrame("float.tiff", Encoded(levels, ".tiff")), HasSubstr("save it as an 8-bit PNG"));
  const cv::Mat deep(testing::kHeightPx, testing::kWidthPx, CV_16UC1, cv::Scalar(3000));
  EXPECT_THAT(ErrorOfFrame("deep.png", Encoded(deep, ".png")), HasSubstr("16 bits a channel"));
  EXPECT_THAT(
      ErrorOf(ErrorKind::kFile, [&] { (void)ReadMaskImage(folder_.path() / "float.tiff", "camera 'a'"); }),
      HasSubstr("doesn't hold whole numbers"));
  EXPECT_EQ(ReadMaskImage(folder_.path() / "deep.png", "camera 'a'").CountObjectPixels(), 96U * 64U);
}

TEST_F(DamagedPicture, WhatIsNoFileIsNotRead) {
  ASSERT_EQ(::mkfifo(folder_.File("pipe.png").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo(folder_.File("pipe.avi").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder_.path() / "zero.png");
  std::filesystem::create_symlink("/dev/zero", folder_.path() / "zero.avi");
  std::ofstream(folder_.File("sparse.png")) << "P5";
  std::filesystem::resize_file(folder_.path() / "sparse.png", 10'000'000'000);
  EXPECT_THAT(ErrorOfFrame("pipe.png"), HasSubstr("can't be opened"));
  EXPECT_THAT(ErrorOfFrame("zero.png"), HasSubstr("can't be opened"));
  EXPECT_THAT(ErrorOfFrame("sparse.png"), HasSubstr("10000000000 bytes"));
  for (const char* video : {"pipe.avi", "zero.avi"}) {
    EXPECT_THAT(
        ErrorOf(ErrorKind::kFile, [&] { (void)OpenImageSource(folder_.File(video), PlainCamera("cam3")); }),
        AllOf(HasSubstr(video), HasSubstr("is not a file")));
  }
}

TEST_F(DamagedPicture, ZerosAfterAVideosHeaderAreNoHang) {
  test_support::WriteText(folder_.path() / "zeros.avi", std::string("RIFF\xf0\xff\xff\x7f"
                                                                    "AVI ",
                                                                    12));
  std::filesystem::resize_file(folder_.path() / "zeros.avi", 2'000'000'000);
  EXPECT_THAT(ErrorOf(ErrorKind::kFile,
                      [&] { (void)OpenImageSource(folder_.File("zeros.avi"), PlainCamera("cam3")); }),
              HasSubstr("zeros.avi"));
}

TEST_F(DamagedPicture, WithinAVideoIsNamedByItsFrame) {
  testing::WriteVideo(folder_.File("v.avi"), 40);
  testing::DamageFrame(folder_.File("v.avi"), 23);
  EXPECT_THAT(ErrorOfVideo("damaged.avi", test_support::ReadText(folder_.path() / "v.avi")),
              AllOf(HasSubstr("cam3"), HasSubstr("damaged.avi"), HasSubstr("damaged at about frame 2")));
}

// The processes whose parent is `parent`.
std::vector<int> ChildrenOf(int parent) {
  std::vector<int> children;
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(parent) + "/task")) {
    std::ifstream list(task.path() / "children");
    children.insert(children.end(), std::istream_iterator<int>(list), std::istream_iterator<int>());
  }
  return children;
}

TEST_F(DamagedPicture, ADecoderThatCrashesIsOneLineAndTheOthersGoOn) {
  testing::WriteVideo(folder_.File("v.avi"), 20);
  const auto source = OpenImageSource(folder_.File("v.avi"), PlainCamera("cam3"));
  const auto other = OpenImageSource(folder_.File("v.avi"), PlainCamera("cam4"));
  EXPECT_EQ(NumberIn(source->Read(3).value().image_bgr), 3);
  const std::vector<int> decoders = ChildrenOf(::getpid());
  ASSERT_EQ(decoders.size(), 1U);
  std::vector<int> workers = ChildrenOf(decoders[0]);
  ASSERT_EQ(workers.size(), 2U);
  ::kill(workers[0], SIGABRT);
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)source->Read(4); }),
              AllOf(HasSubstr("cam3"), HasSubstr("v.avi"), HasSubstr("frame 4"),
                    HasSubstr("its decoder crashed (ABRT)")));
  EXPECT_EQ(NumberIn(other->Read(7).value().image_bgr), 7);
  EXPECT_EQ(NumberIn(source->Read(5).value().image_bgr), 5);  // with another worker

  ::kill(decoders[0], SIGKILL);  // takes its workers with it, a moment later
  std::string message;
  while (message.empty()) {
    try {
      EXPECT_EQ(NumberIn(source->Read(6).value().image_bgr), 6);
    } catch (const core::Error& error) {
      message = error.what();
    }
  }
  EXPECT_THAT(message, AllOf(HasSubstr("cam3"), HasSubstr("its decoder is gone")));
  EXPECT_EQ(NumberIn(source->Read(6).value().image_bgr), 6);  // of another decoder
}

}  // namespace
}  // namespace elbowroom::recon
