#include "recon/capture/device/pixel_layout.h"

#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

int CodeOf(PixelLayout layout) {
  switch (layout) {
    case PixelLayout::kMono8:
      return cv::COLOR_GRAY2BGR;
    case PixelLayout::kRgb8:
      return cv::COLOR_RGB2BGR;
    case PixelLayout::kBayerRg8:
      return cv::COLOR_BayerRGGB2BGR;
    case PixelLayout::kBayerGr8:
      return cv::COLOR_BayerGRBG2BGR;
    case PixelLayout::kBayerGb8:
      return cv::COLOR_BayerGBRG2BGR;
    case PixelLayout::kBayerBg8:
      return cv::COLOR_BayerBGGR2BGR;
    case PixelLayout::kYuyv:
      return cv::COLOR_YUV2BGR_YUYV;
    case PixelLayout::kBgr8:
      break;
  }
  throw core::PreconditionError("this layout needs no conversion");
}

int ChannelsOf(PixelLayout layout) {
  switch (layout) {
    case PixelLayout::kRgb8:
    case PixelLayout::kBgr8:
      return 3;
    case PixelLayout::kYuyv:
      return 2;
    case PixelLayout::kMono8:
    case PixelLayout::kBayerRg8:
    case PixelLayout::kBayerGr8:
    case PixelLayout::kBayerGb8:
    case PixelLayout::kBayerBg8:
      return 1;
  }
  throw core::PreconditionError("this layout has no channels");
}

}  // namespace

std::size_t BytesPerRow(PixelLayout layout, int width_px) {
  return static_cast<std::size_t>(ChannelsOf(layout)) * static_cast<std::size_t>(width_px);
}

void ToBgr(std::span<const std::byte> bytes, PixelLayout layout, cv::Size size_px, std::size_t row_bytes,
           cv::Mat& image_bgr) {
  const std::size_t least = BytesPerRow(layout, size_px.width);
  core::Require(row_bytes >= least, "a row holds its pixels");
  core::Require(
      size_px.height > 0 && bytes.size() >= row_bytes * static_cast<std::size_t>(size_px.height - 1) + least,
      "a picture's bytes hold its rows");
  // OpenCV only reads it.
  const cv::Mat stored(size_px, CV_8UC(ChannelsOf(layout)), const_cast<std::byte*>(bytes.data()),
                       row_bytes);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  if (layout == PixelLayout::kBgr8) {
    stored.copyTo(image_bgr);
  } else {
    cv::cvtColor(stored, image_bgr, CodeOf(layout));
  }
}

}  // namespace elbowroom::recon
