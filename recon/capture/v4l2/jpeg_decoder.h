// The JPEG pictures that webcams send.
#pragma once

#include <cstddef>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>

namespace elbowroom::recon {

// Thread: one.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  // Writes the picture into `image_bgr`, CV_8UC3 of the size that is expected. False: it is damaged, also
  // where the decoder could go on, or has another size; the pixels are of no meaning then.
  [[nodiscard]] bool Decode(std::span<const std::byte> bytes, cv::Mat& image_bgr);

 private:
  void Begin();

  void* decoder_ = nullptr;
};

}  // namespace elbowroom::recon
