#include "app/control/tiles/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "recon/images/mask_image.h"

namespace elbowroom::control {
namespace {

// A quarter of a small pixel is object where a finger of one pixel crosses two.
constexpr std::uint8_t kLeastShare = 64;  // of 255

cv::Size SizeWithin(const core::BitMask& mask, const ThumbnailRoom& room) {
  const double scale = std::min({1.0, static_cast<double>(room.width_px) / mask.width_px(),
                                 static_cast<double>(room.height_px) / mask.height_px()});
  const auto scaled = [scale](int side_px) {
    return std::max(1, static_cast<int>(std::lround(scale * side_px)));
  };
  return {scaled(mask.width_px()), scaled(mask.height_px())};
}

// Halved by means while it is twice too large, which is quick, and interpolated for what is left.
cv::Mat Shrunk(const cv::Mat& image, const cv::Size& size) {
  cv::Mat shrunk = image;
  while (shrunk.cols >= 2 * size.width && shrunk.rows >= 2 * size.height && shrunk.cols % 2 == 0 &&
         shrunk.rows % 2 == 0) {
    cv::Mat half;
    cv::resize(shrunk, half, shrunk.size() / 2, 0.0, 0.0, cv::INTER_AREA);
    shrunk = half;
  }
  if (shrunk.size() == size) return shrunk;
  cv::Mat fitted;
  cv::resize(shrunk, fitted, size, 0.0, 0.0, cv::INTER_LINEAR);
  return fitted;
}

cv::Vec3b Pixel(const ThumbnailColor& color) { return {color[0], color[1], color[2]}; }

// From background to object by `share`, 8 bits.
cv::Mat Tinted(const cv::Mat& share) {
  cv::Mat rgb(share.size(), CV_8UC3);
  for (int y = 0; y < share.rows; ++y) {
    for (int x = 0; x < share.cols; ++x) {
      const int of_255 = share.at<std::uint8_t>(y, x);
      cv::Vec3b& pixel = rgb.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        pixel[c] = static_cast<std::uint8_t>(kMaskBackground[at] +
                                             (kMaskObject[at] - kMaskBackground[at]) * of_255 / 255);
      }
    }
  }
  return rgb;
}

// Marks the pixels on both sides of the boundary; the picture's edge is none.
void DrawOutline(const cv::Mat& share, cv::Mat& rgb) {
  const auto is_object = [](std::uint8_t value) { return value >= kLeastShare; };
  for (int y = 0; y < share.rows; ++y) {
    const auto* row = share.ptr<std::uint8_t>(y);
    const auto* above = share.ptr<std::uint8_t>(std::max(0, y - 1));
    const auto* below = share.ptr<std::uint8_t>(std::min(share.rows - 1, y + 1));
    auto* pixels = rgb.ptr<cv::Vec3b>(y);
    for (int x = 0; x < share.cols; ++x) {
      const bool object = is_object(row[x]);
      const int left = std::max(0, x - 1), right = std::min(share.cols - 1, x + 1);
      const bool is_inside = is_object(row[left]) == object && is_object(row[right]) == object &&
                             is_object(above[x]) == object && is_object(below[x]) == object;
      if (!is_inside) pixels[x] = Pixel(object ? kOutline : kOutlineShade);
    }
  }
}

}  // namespace

recon::Image ThumbnailOf(const cv::Mat& image_bgr, const core::BitMask& mask, const ThumbnailRoom& room) {
  core::Require(image_bgr.empty() || image_bgr.size() == cv::Size(mask.width_px(), mask.height_px()),
                "a thumbnail's picture has its mask's size");
  if (room.is_empty() || mask.width_px() == 0 || mask.height_px() == 0) return {};
  const cv::Size size = SizeWithin(mask, room);
  const cv::Mat share = Shrunk(recon::ImageFromMask(mask), size);
  cv::Mat rgb;
  if (image_bgr.empty()) {
    rgb = Tinted(share);
  } else {
    cv::cvtColor(Shrunk(image_bgr, size), rgb, cv::COLOR_BGR2RGB);
  }
  DrawOutline(share, rgb);
  return {rgb.cols, rgb.rows, {rgb.datastart, rgb.dataend}};
}

}  // namespace elbowroom::control
