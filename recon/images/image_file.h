// Images read from files, with every defect found instead of decoded over.
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

// Pixels of the largest picture that is read where nobody knows how large it must be.
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 26U;

// Reads pictures of one size, one after the other, decoding them in a child process. Thread: one at a time.
class ImageReader {
 public:
  // `who` opens messages, as in "camera 'cam01'". Without a size: up to kMostPixels.
  explicit ImageReader(std::string who, std::optional<cv::Size> size_px = std::nullopt);

  // Reads the file's bytes and its header. Throws: Error{kFile} naming `who` and the file: missing, no
  // regular file, larger than a picture of that size is, empty, cut short (a PNG without its end, a JPEG
  // without its end marker), or no PNG, JPEG, TIFF, BMP, PGM or PPM. Nothing is decoded yet: the caller looks
  // at the size.
  [[nodiscard]] const PictureHeader& Open(const std::filesystem::path& path);

  // The opened picture: as stored (8 or 16 bit, 1, 3 or 4 channels), or as 8-bit BGR, which must be stored
  // with at most 8 bits a channel. Throws: Error{kFile} naming `who` and the file when the decoder finds
  // damage, warns of some, crashes or takes too long, and for bits or numbers that aren't taken;
  // Error{kCancelled}.
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
