// Reads images from files. Damage is an error, even where a decoder would read past it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "recon/decoding/picture_codecs.h"
#include "recon/decoding/picture_worker.h"
#include "recon/images/picture_header.h"

namespace elbowroom::recon {

// The most pixels that a picture may have if its size isn't known beforehand.
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 26U;

// Reads pictures of one size, one after the other, decoding them in a child process. Thread: one at a time.
class ImageReader {
 public:
  // `who` begins messages, as in "camera 'cam01'". Without a size: up to kMostPixels.
  explicit ImageReader(std::string who, std::optional<cv::Size> size_px = std::nullopt);

  // Reads the file's bytes and its header. Nothing is decoded yet, so that the caller can check the size.
  // Throws: Error{kFile} naming `who` and the file if it is missing, no regular file, larger than a picture
  // of that size needs, empty, cut short (a PNG without its end, a JPEG without its end marker), damaged (a
  // PNG with a wrong check sum), or no PNG, JPEG, TIFF, BMP, PGM or PPM, or if its header claims 0 pixels or,
  // without a given size, more than kMostPixels.
  [[nodiscard]] const PictureHeader& Open(const std::filesystem::path& path);

  // The opened picture: as stored (8 or 16 bit, 1, 3 or 4 channels), or as 8-bit BGR, which must be stored
  // with at most 8 bits a channel. Throws: Error{kFile} naming `who` and the file when the decoder reports
  // damage, crashes or takes too long, and for other bits or numbers than these; Error{kCancelled} on a stop;
  // PreconditionError for another size than the given one.
  [[nodiscard]] cv::Mat Decode(DecodedAs as, const std::stop_token& stop);

 private:
  [[noreturn]] void Fail(const std::string& what) const;
  [[nodiscard]] std::string ReadBytes() const;
  void RequireBits(DecodedAs as) const;

  std::string who_;
  std::optional<cv::Size> size_px_;
  std::filesystem::path path_;
  std::string bytes_;
  PictureHeader header_;
  std::unique_ptr<PictureWorker> worker_;  // for pictures of one size
};

}  // namespace elbowroom::recon
