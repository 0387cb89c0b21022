#include "recon/images/picture_header.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <tuple>
#include <vector>

namespace elbowroom::recon {
namespace {

std::string EncodedAs(const cv::Mat& image, const std::string& extension) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes);
  return {bytes.begin(), bytes.end()};
}

struct Written {
  const char* extension;
  int type;
  PictureFormat format;
  int bits;
  bool is_whole_numbers = true;
};

const std::vector<Written> kWritten{
    {".png", CV_8UC1, PictureFormat::kPng, 8},     {".png", CV_8UC3, PictureFormat::kPng, 8},
    {".png", CV_16UC1, PictureFormat::kPng, 16},   {".png", CV_8UC4, PictureFormat::kPng, 8},
    {".jpg", CV_8UC1, PictureFormat::kJpeg, 8},    {".jpg", CV_8UC3, PictureFormat::kJpeg, 8},
    {".bmp", CV_8UC1, PictureFormat::kBmp, 8},     {".bmp", CV_8UC3, PictureFormat::kBmp, 8},
    {".tiff", CV_8UC1, PictureFormat::kTiff, 8},   {".tiff", CV_8UC3, PictureFormat::kTiff, 8},
    {".tiff", CV_16UC3, PictureFormat::kTiff, 16}, {".tiff", CV_32FC1, PictureFormat::kTiff, 32, false},
    {".pgm", CV_8UC1, PictureFormat::kPnm, 8},     {".ppm", CV_8UC3, PictureFormat::kPnm, 8},
    {".pgm", CV_16UC1, PictureFormat::kPnm, 16},   {".pbm", CV_8UC1, PictureFormat::kPnm, 1},
};

TEST(PictureHeader, SaysWhatOpenCvWrote) {
  for (const Written& written : kWritten) {
    SCOPED_TRACE(std::string(written.extension) + " " + std::to_string(written.type));
    const std::string bytes = EncodedAs(cv::Mat(41, 67, written.type, cv::Scalar::all(1)), written.extension);
    const auto header = ReadPictureHeader(bytes);
    ASSERT_TRUE(header.has_value());
    EXPECT_EQ(header->format, written.format);
    EXPECT_EQ(header->width_px, 67);
    EXPECT_EQ(header->height_px, 41);
    EXPECT_EQ(header->bits, written.bits);
    EXPECT_EQ(header->is_whole_numbers, written.is_whole_numbers);
    EXPECT_FALSE(DefectOfPicture(bytes).has_value());
  }
}

TEST(PictureHeader, OfAFileThatEndsAnywhereIsTheSameOrNone) {
  for (const Written& written : kWritten) {
    SCOPED_TRACE(std::string(written.extension) + " " + std::to_string(written.type));
    const std::string bytes = EncodedAs(cv::Mat(7, 9, written.type, cv::Scalar::all(1)), written.extension);
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
      const auto header = ReadPictureHeader(std::string_view(bytes).substr(0, size));
      if (!header || written.format == PictureFormat::kPnm) continue;  // a cut "12" is 1
      EXPECT_EQ(std::tuple(header->width_px, header->height_px), std::tuple(9, 7)) << size;
    }
  }
}

TEST(PictureHeader, KnowsATopDownAndAnOldBitmap) {
  std::string bytes = EncodedAs(cv::Mat(7, 9, CV_8UC3, cv::Scalar::all(1)), ".bmp");
  bytes.replace(22, 4, "\xf9\xff\xff\xff");  // -7
  EXPECT_EQ(ReadPictureHeader(bytes)->height_px, 7);
  EXPECT_EQ(ReadPictureHeader(std::string("BM............\x0c\0\0\0\x09\0\x07\0", 22))->width_px, 9);
}

TEST(PictureHeader, IsNoneOfOtherFiles) {
  for (const std::string& bytes : {std::string("RIFF....WEBPVP8 "), std::string("v/1\x01......"),
                                   std::string("Pf\n"), std::string("\xff\xd8\xff\xda\0\x08\0\0\0\0\0\0", 12),
                                   std::string("P5"), std::string("P5 # no more"), std::string()}) {
    EXPECT_FALSE(ReadPictureHeader(bytes).has_value()) << bytes;
  }
}

TEST(DecodableBytes, OfAPngAreThoseThatSayItsPixels) {
  const std::string png = EncodedAs(cv::Mat(7, 9, CV_8UC3, cv::Scalar::all(1)), ".png");
  const std::size_t after_header = 8 + 25;
  std::string with_text = png;
  with_text.insert(after_header, std::string("\0\0\0\4zTXtabcd....", 16));
  EXPECT_EQ(DecodableBytes(with_text, PictureFormat::kPng), DecodableBytes(png, PictureFormat::kPng));
  EXPECT_EQ(DecodableBytes(png, PictureFormat::kPng), png);
}

}  // namespace
}  // namespace elbowroom::recon
