#include "recon/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "recon/picture_codecs.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

constexpr std::string_view kPngSignature{"\x89PNG\r\n\x1a\n", 8};
constexpr std::string_view kJpegSignature{"\xff\xd8\xff", 3};
// Cameras pad a JPEG's end; the marker is looked for in the last bytes only.
constexpr std::size_t kJpegTailBytes = 4096;

std::string ReadBytes(const std::filesystem::path& path, const std::string& who) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw Error(ErrorKind::kFile,
                fmt::format("{}: image '{}' does not exist; check the path", who, path.string()));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path, ignored)) {
    throw Error(ErrorKind::kFile,
                fmt::format("{}: image '{}' can't be opened; check that it is a file and may be read", who,
                            path.string()));
  }
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// CRC-32 as PNG has it (ISO 3309), of `bytes`.
std::uint32_t Crc32(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value & 1U) != 0 ? 0xEDB88320U ^ (value >> 1U) : value >> 1U;
      table[i] = value;
    }
    return table;
  }();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) crc = kTable[(crc ^ static_cast<unsigned char>(byte)) & 0xFFU] ^ (crc >> 8U);
  return ~crc;
}

std::uint32_t BigEndian32(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[i]);
  return value;
}

enum class PngState { kWhole, kCutShort, kDamaged };

// By its chunks and their check sums: libpng would find the same, but tells stderr.
PngState StateOfPng(std::string_view bytes) {
  constexpr std::size_t kAroundContent = 12;  // 4 bytes length, 4 type, 4 check sum
  std::size_t at = kPngSignature.size();
  while (at + kAroundContent <= bytes.size()) {
    const std::size_t length = BigEndian32(bytes.substr(at));
    if (at + kAroundContent + length > bytes.size()) return PngState::kCutShort;
    const std::string_view type_and_content = bytes.substr(at + 4, 4 + length);
    if (Crc32(type_and_content) != BigEndian32(bytes.substr(at + 8 + length))) return PngState::kDamaged;
    if (type_and_content.starts_with("IEND")) return PngState::kWhole;
    at += kAroundContent + length;
  }
  return PngState::kCutShort;
}

bool IsJpegCutShort(std::string_view bytes) {
  const std::string_view tail = bytes.substr(bytes.size() - std::min(bytes.size(), kJpegTailBytes));
  return tail.find("\xff\xd9") == std::string_view::npos;
}

// What is wrong with an image file, if that shows before it is decoded.
std::optional<std::string> DefectOf(std::string_view bytes) {
  if (bytes.empty()) return "is empty (0 bytes); write it again";
  const bool is_png = bytes.starts_with(kPngSignature);
  const PngState png = is_png ? StateOfPng(bytes) : PngState::kWhole;
  if (png == PngState::kDamaged) return "is damaged (a check sum fails); write or copy it again";
  if (png == PngState::kCutShort || (bytes.starts_with(kJpegSignature) && IsJpegCutShort(bytes))) {
    return fmt::format("is cut short ({} bytes, its end is missing); write or copy it again", bytes.size());
  }
  return std::nullopt;
}

cv::Mat Decode(const std::filesystem::path& path, DecodedAs as, const std::string& who) {
  const std::string bytes = ReadBytes(path, who);
  const auto fail = [&](std::string_view what) {
    throw Error(ErrorKind::kFile, fmt::format("{}: image '{}' {}", who, path.string(), what));
  };
  if (const auto defect = DefectOf(bytes)) fail(*defect);
  cv::Mat image = LoadedPictureCodecs().decode(bytes, as);
  if (image.empty()) fail("can't be decoded; it must be an intact PNG, JPEG, TIFF or BMP");
  return image;
}

}  // namespace

cv::Mat ReadImageAsStored(const std::filesystem::path& path, const std::string& who) {
  return Decode(path, DecodedAs::kStored, who);
}

cv::Mat ReadImageBgr(const std::filesystem::path& path, const std::string& who) {
  return Decode(path, DecodedAs::kBgr, who);
}

bool IsJpeg(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(kJpegSignature.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return file && start == kJpegSignature;
}

}  // namespace elbowroom::recon
