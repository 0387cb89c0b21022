#include "recon/images/mask_image.h"

#include <fmt/format.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/system/whole_file.h"
#include "recon/images/image_file.h"
#include "recon/images/picture_encoder.h"

namespace elbowroom::recon {
namespace {

// 1 channel, 8 bit, non-zero where `image` is object.
cv::Mat Flattened(const cv::Mat& image) {
  cv::Mat nonzero = image != 0;  // 255 a channel
  if (nonzero.channels() == 1) return nonzero;
  std::vector<cv::Mat> channels;
  cv::split(nonzero, channels);
  if (channels.size() == 4 || channels.size() == 2) channels.pop_back();  // alpha
  cv::Mat any = channels.front();
  for (std::size_t i = 1; i < channels.size(); ++i) any |= channels[i];
  return any;
}

}  // namespace

core::BitMask MaskFromImage(const cv::Mat& image) {
  core::Require(!image.empty(), "a mask image has pixels");
  const cv::Mat flat = Flattened(image);
  core::BitMask mask(flat.cols, flat.rows);
  const auto words = mask.words();
  for (int y = 0; y < flat.rows; ++y) {
    const auto* row = flat.ptr<std::uint8_t>(y);
    std::uint64_t* out = words.data() + static_cast<std::size_t>(y) * mask.words_per_row();
    for (int x = 0; x < flat.cols; ++x) {
      out[x >> 6] |= std::uint64_t{row[x] != 0} << (static_cast<unsigned>(x) & 63U);
    }
  }
  return mask;
}

cv::Mat ImageFromMask(const core::BitMask& mask) {
  cv::Mat image(mask.height_px(), mask.width_px(), CV_8U);
  const auto words = mask.words();
  for (int y = 0; y < image.rows; ++y) {
    auto* row = image.ptr<std::uint8_t>(y);
    const std::uint64_t* in = words.data() + static_cast<std::size_t>(y) * mask.words_per_row();
    for (int x = 0; x < image.cols; ++x) {
      row[x] = ((in[x >> 6] >> (static_cast<unsigned>(x) & 63U)) & 1U) != 0 ? 255 : 0;
    }
  }
  return image;
}

void RequireExactMask(const PictureHeader& header, const std::filesystem::path& path,
                      const std::string& who) {
  if (header.format != PictureFormat::kJpeg) return;
  throw core::Error(core::ErrorKind::kFormat,
                    fmt::format("{}: mask '{}' is a JPEG, whose rounding turns background into object; "
                                "save masks as PNG",
                                who, path.string()));
}

core::BitMask ReadMaskImage(const std::filesystem::path& path, const std::string& who) {
  ImageReader reader(who);
  RequireExactMask(reader.Open(path), path, who);
  return MaskFromImage(reader.Decode(DecodedAs::kStored, {}));
}

void WriteMaskPng(const core::BitMask& mask, const std::filesystem::path& path) {
  core::Require(mask.width_px() > 0 && mask.height_px() > 0, "a mask that is written has pixels");
  const std::vector<std::uint8_t> png = EncodePicture(ImageFromMask(mask), ".png");
  core::WriteWholeFile(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace elbowroom::recon
