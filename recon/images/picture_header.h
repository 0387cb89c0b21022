// What a picture file says of itself, before anybody decodes it.
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

// The header of the first picture in `bytes`, a whole file. Nothing for another format, and where no size is
// found. Reads no more than it needs, whatever the bytes are. Thread: any.
[[nodiscard]] std::optional<PictureHeader> ReadPictureHeader(std::string_view bytes);

// What is wrong with a picture file, if that shows before it is decoded: "is empty (0 bytes); write it
// again". A PNG without its end or with a wrong check sum, a JPEG without its end.
[[nodiscard]] std::optional<std::string> DefectOfPicture(std::string_view bytes);

// The bytes to decode: of a PNG only the chunks that say what its pixels are, since others may unpack to
// anything; of a JPEG more end markers than any reader skips, since OpenCV passes over a picture that ends
// too early in silence, and libjpeg warns of an end marker.
[[nodiscard]] std::string DecodableBytes(std::string_view bytes, PictureFormat format);

}  // namespace elbowroom::recon
