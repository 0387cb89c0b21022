#include "recon/image_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

// Removes the half-written file unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

std::vector<std::uint8_t> EncodePng(const Image& image) {
  core::Require(image.width_px > 0 && image.height_px > 0, "an image to encode has pixels");
  const std::size_t bytes =
      3 * static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  core::Require(image.rgb.size() == bytes, "an image holds 3 bytes a pixel");
  // OpenCV's header type takes a mutable pointer; cvtColor only reads it.
  const cv::Mat rgb(image.height_px, image.width_px, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> png;
  cv::imencode(".png", bgr, png);
  return png;
}

void WritePng(const Image& image, const std::filesystem::path& path) {
  const std::vector<std::uint8_t> png = EncodePng(image);
  std::filesystem::path beside = path;
  beside += fmt::format(".{}.partial", ::getpid());
  const TemporaryFile temporary(beside);
  {
    std::ofstream out(temporary.path(), std::ios::binary);
    out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    out.close();
    if (!out) {
      throw Error(ErrorKind::kFile, fmt::format("cannot write picture '{}': check that its folder exists, is "
                                                "writable and has room",
                                                path.string()));
    }
  }
  std::error_code failure;
  std::filesystem::rename(temporary.path(), path, failure);
  if (failure) {
    throw Error(ErrorKind::kFile, fmt::format("cannot write picture '{}': {}; choose another path",
                                              path.string(), failure.message()));
  }
}

}  // namespace elbowroom::recon
