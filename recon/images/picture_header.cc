#include "recon/images/picture_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>

namespace elbowroom::recon {
namespace {

constexpr std::string_view kPngSignature{"\x89PNG\r\n\x1a\n", 8};
constexpr std::string_view kJpegSignature{"\xff\xd8\xff", 3};
constexpr std::string_view kJpegEnd{"\xff\xd9", 2};
// Longer than any segment of a JPEG, which a reader may skip at its end.
constexpr std::size_t kJpegPaddingBytes = std::size_t{68} << 10U;

// Reads numbers at given places of a file; nothing beyond its end.
class Numbers {
 public:
  Numbers(std::string_view bytes, bool is_big_endian) : bytes_(bytes), is_big_endian_(is_big_endian) {}

  [[nodiscard]] std::optional<std::uint32_t> At(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = is_big_endian_ ? i : size - 1 - i;
      value = value << 8U | static_cast<unsigned char>(bytes_[at + place]);
    }
    return value;
  }

 private:
  std::string_view bytes_;
  bool is_big_endian_;
};

std::uint32_t BigEndian32(std::string_view bytes) { return Numbers(bytes, true).At(0, 4).value_or(0); }

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

constexpr std::size_t kAroundChunk = 12;  // of a PNG: 4 bytes length, 4 type, 4 check sum

// The chunk that begins `bytes`, if it lies in there whole.
std::optional<std::string_view> FirstChunk(std::string_view bytes) {
  if (bytes.size() < kAroundChunk) return std::nullopt;
  const std::size_t length = BigEndian32(bytes);
  if (length > bytes.size() - kAroundChunk) return std::nullopt;
  return bytes.substr(0, kAroundChunk + length);
}

enum class PngState { kWhole, kCutShort, kDamaged };

// Decided by its chunks and their check sums. libpng finds the same damage, but says less about it.
PngState StateOfPng(std::string_view bytes) {
  bytes.remove_prefix(kPngSignature.size());
  while (const auto chunk = FirstChunk(bytes)) {
    const std::string_view type_and_content = chunk->substr(4, chunk->size() - 8);
    if (Crc32(type_and_content) != BigEndian32(chunk->substr(chunk->size() - 4))) return PngState::kDamaged;
    if (type_and_content.starts_with("IEND")) return PngState::kWhole;
    bytes.remove_prefix(chunk->size());
  }
  return PngState::kCutShort;
}

std::optional<PictureHeader> PngHeader(std::string_view bytes) {
  const auto chunk = FirstChunk(bytes.substr(kPngSignature.size()));
  constexpr std::size_t kHeaderChunkBytes = kAroundChunk + 13;
  if (!chunk || chunk->size() != kHeaderChunkBytes || chunk->substr(4, 4) != "IHDR") return std::nullopt;
  return PictureHeader{PictureFormat::kPng, BigEndian32(chunk->substr(8)), BigEndian32(chunk->substr(12)),
                       static_cast<unsigned char>((*chunk)[16])};
}

// The frame header (SOF) that comes before the first scan.
std::optional<PictureHeader> JpegHeader(std::string_view bytes) {
  const Numbers numbers(bytes, true);
  std::size_t at = 2;  // after the start marker
  for (;;) {
    while (at + 1 < bytes.size() && bytes[at] == '\xff' && bytes[at + 1] == '\xff') ++at;  // fill bytes
    const auto marker = numbers.At(at, 2), length = numbers.At(at + 2, 2);
    if (!marker || !length || (*marker & 0xFF00U) != 0xFF00U || *length < 2) return std::nullopt;
    const unsigned kind = *marker & 0xFFU;
    if (kind == 0x01U || (kind >= 0xD0U && kind <= 0xD9U)) {
      at += 2;  // these stand alone
      continue;
    }
    const bool is_frame = kind >= 0xC0U && kind <= 0xCFU && kind != 0xC4U && kind != 0xC8U && kind != 0xCCU;
    if (is_frame) {
      const auto bits = numbers.At(at + 4, 1), height = numbers.At(at + 5, 2), width = numbers.At(at + 7, 2);
      if (!width) return std::nullopt;
      return PictureHeader{PictureFormat::kJpeg, *width, *height, static_cast<int>(*bits)};
    }
    if (kind == 0xDAU) return std::nullopt;  // a scan without a frame
    at += 2 + *length;
  }
}

std::optional<PictureHeader> BmpHeader(std::string_view bytes) {
  const Numbers numbers(bytes, false);
  const auto header_bytes = numbers.At(14, 4);
  constexpr std::uint32_t kOldHeaderBytes = 12;
  if (header_bytes == kOldHeaderBytes) {
    const auto width = numbers.At(18, 2), height = numbers.At(20, 2);
    if (!height) return std::nullopt;
    return PictureHeader{PictureFormat::kBmp, *width, *height};
  }
  const auto width = numbers.At(18, 4), height = numbers.At(22, 4);
  if (!height) return std::nullopt;
  // Negative heights count from the top.
  return PictureHeader{PictureFormat::kBmp, static_cast<std::int32_t>(*width),
                       std::abs(std::int64_t{static_cast<std::int32_t>(*height)})};
}

// The first of the values of an entry in a TIFF's directory.
std::optional<std::uint32_t> FirstValue(const Numbers& numbers, std::size_t entry) {
  const auto type = numbers.At(entry + 2, 2), count = numbers.At(entry + 4, 4);
  constexpr std::uint32_t kByte = 1, kShort = 3, kLong = 4;
  if (!type || !count || *count == 0) return std::nullopt;
  if (*type == kByte) return *count <= 4 ? numbers.At(entry + 8, 1) : std::nullopt;
  if (*type == kLong && *count == 1) return numbers.At(entry + 8, 4);
  if (*type != kShort) return std::nullopt;
  if (*count <= 2) return numbers.At(entry + 8, 2);
  const auto place = numbers.At(entry + 8, 4);
  return place ? numbers.At(*place, 2) : std::nullopt;
}

std::optional<PictureHeader> TiffHeader(std::string_view bytes) {
  constexpr std::uint32_t kWidth = 256, kHeight = 257, kBits = 258, kSampleFormat = 339, kUnsigned = 1;
  constexpr std::size_t kEntryBytes = 12;
  const Numbers numbers(bytes, bytes.starts_with("MM"));
  const auto directory = numbers.At(4, 4);
  const auto entries = directory ? numbers.At(*directory, 2) : std::nullopt;
  if (!entries) return std::nullopt;
  PictureHeader header{PictureFormat::kTiff};
  header.bits = 1;  // unless the directory gives another number
  for (std::size_t i = 0; i < *entries; ++i) {
    const std::size_t entry = *directory + 2 + i * kEntryBytes;
    const auto tag = numbers.At(entry, 2);
    if (!tag) return std::nullopt;
    const auto value = FirstValue(numbers, entry);
    if (!value) continue;
    if (*tag == kWidth) header.width_px = *value;
    if (*tag == kHeight) header.height_px = *value;
    if (*tag == kBits) header.bits = static_cast<int>(std::min(*value, 64U));
    if (*tag == kSampleFormat) header.is_whole_numbers = *value == kUnsigned;
  }
  return header;
}

// Text: "P5 width height most", with comments to the end of a line anywhere.
std::optional<PictureHeader> PnmHeader(std::string_view bytes) {
  constexpr std::int64_t kLargest = 1'000'000'000;
  const bool is_bits = bytes[1] == '1' || bytes[1] == '4';
  std::array<std::int64_t, 3> numbers{0, 0, 1};
  std::size_t at = 2;
  for (std::size_t i = 0; i < (is_bits ? 2U : 3U); ++i) {
    while (at < bytes.size() &&
           (std::isspace(static_cast<unsigned char>(bytes[at])) != 0 || bytes[at] == '#')) {
      at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    }
    const std::size_t begin = at;
    for (; at < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[at])) != 0; ++at) {
      numbers[i] = std::min(kLargest, (at == begin ? 0 : numbers[i]) * 10 + (bytes[at] - '0'));
    }
    if (at == begin) return std::nullopt;
  }
  constexpr std::int64_t kMostOfByte = 255;
  return PictureHeader{PictureFormat::kPnm, numbers[0], numbers[1],
                       is_bits ? 1 : (numbers[2] > kMostOfByte ? 16 : 8)};
}

std::string PixelChunks(std::string_view png) {
  std::string kept(png.substr(0, kPngSignature.size()));
  png.remove_prefix(kPngSignature.size());
  while (const auto chunk = FirstChunk(png)) {
    const std::string_view type = chunk->substr(4, 4);
    const bool is_critical = std::isupper(static_cast<unsigned char>(type[0])) != 0;
    if (is_critical || type == "tRNS") kept += *chunk;
    if (type == "IEND") break;
    png.remove_prefix(chunk->size());
  }
  return kept;
}

}  // namespace

std::optional<PictureHeader> ReadPictureHeader(std::string_view bytes) {
  if (bytes.starts_with(kPngSignature)) return PngHeader(bytes);
  if (bytes.starts_with(kJpegSignature)) return JpegHeader(bytes);
  if (bytes.starts_with("BM")) return BmpHeader(bytes);
  if (bytes.starts_with(std::string_view("II\x2a\0", 4)) ||
      bytes.starts_with(std::string_view("MM\0\x2a", 4)))
    return TiffHeader(bytes);
  if (bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') return PnmHeader(bytes);
  return std::nullopt;
}

std::optional<std::string> DefectOfPicture(std::string_view bytes) {
  if (bytes.empty()) return "is empty (0 bytes); write it again";
  const bool is_png = bytes.starts_with(kPngSignature);
  const PngState png = is_png ? StateOfPng(bytes) : PngState::kWhole;
  if (png == PngState::kDamaged) return "is damaged (a check sum fails); write or copy it again";
  // The end marker may be anywhere, since cameras and telephones write more data after it. If it comes too
  // early, the decoder finds that.
  const bool has_end = !bytes.starts_with(kJpegSignature) || bytes.find(kJpegEnd) != std::string_view::npos;
  if (png == PngState::kCutShort || !has_end) {
    return fmt::format("is cut short ({} bytes, its end is missing); write or copy it again", bytes.size());
  }
  return std::nullopt;
}

std::string DecodableBytes(std::string_view bytes, PictureFormat format) {
  if (format == PictureFormat::kPng) return PixelChunks(bytes);
  std::string padded(bytes);
  if (format != PictureFormat::kJpeg) return padded;
  padded.reserve(bytes.size() + kJpegPaddingBytes);
  while (padded.size() < bytes.size() + kJpegPaddingBytes) padded += kJpegEnd;
  return padded;
}

}  // namespace elbowroom::recon
