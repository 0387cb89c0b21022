// The header of a picture file, read without decoding the picture.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace elbowroom::recon {

enum class PictureFormat { kPng, kJpeg, kBmp, kTiff, kPnm };

struct PictureHeader {
  PictureFormat format = PictureFormat::kPng;
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  int bits = 8;                  // a channel
  bool is_whole_numbers = true;  // false: floating-point or signed
};

// The header of the first picture in `bytes`, a whole file. Nothing for another format, and for a header that
// is incomplete; a TIFF that gives no size has 0 x 0 pixels. Reads only within `bytes`, whatever they are.
// Thread: any.
[[nodiscard]] std::optional<PictureHeader> ReadPictureHeader(std::string_view bytes);

// The defect of a picture file, as far as it shows without decoding, as a text: "is empty (0 bytes); write it
// again". Found are an empty file, a PNG without its end or with a wrong check sum, and a JPEG without its
// end marker.
[[nodiscard]] std::optional<std::string> DefectOfPicture(std::string_view bytes);

// The bytes to decode. A PNG keeps only the chunks that define its pixels, since others may unpack to any
// size. A JPEG gets more end markers than any reader skips: OpenCV accepts a picture that ends too early
// without a warning, but libjpeg warns of an end marker.
[[nodiscard]] std::string DecodableBytes(std::string_view bytes, PictureFormat format);

}  // namespace elbowroom::recon
