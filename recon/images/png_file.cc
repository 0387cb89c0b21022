#include "recon/images/png_file.h"

#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/system/whole_file.h"
#include "recon/images/picture_encoder.h"

namespace elbowroom::recon {
std::vector<std::uint8_t> EncodePng(const Image& image) {
  core::Require(image.width_px > 0 && image.height_px > 0, "an image to encode has pixels");
  const std::size_t bytes =
      3 * static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  core::Require(image.rgb.size() == bytes, "an image holds 3 bytes a pixel");
  // OpenCV's header type takes a mutable pointer; cvtColor only reads it.
  const cv::Mat rgb(image.height_px, image.width_px, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return EncodePicture(bgr, ".png");
}

void WritePng(const Image& image, const std::filesystem::path& path) {
  const std::vector<std::uint8_t> png = EncodePng(image);
  core::WriteWholeFile(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace elbowroom::recon
