#include "recon/footage/container_check.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>
#include <string_view>

namespace elbowroom::recon {
namespace {

// The header of a chunk (AVI) or box (MP4): 4 bytes each for its type and its size.
constexpr std::uint64_t kHeaderBytes = 8;

class ByteReader {
 public:
  explicit ByteReader(const std::filesystem::path& path) : file_(path, std::ios::binary) {
    file_.seekg(0, std::ios::end);
    size_ = file_ ? static_cast<std::uint64_t>(file_.tellg()) : 0;
  }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  // The `n` bytes at `at`; empty if the file ends before.
  [[nodiscard]] std::string At(std::uint64_t at, std::size_t n) {
    if (at > size_ || n > size_ - at) return {};
    if (at < window_at_ || at + n > window_at_ + window_.size()) {
      window_at_ = at;
      window_.assign(std::max(n, static_cast<std::size_t>(std::min<std::uint64_t>(kWindowBytes, size_ - at))),
                     '\0');
      file_.seekg(static_cast<std::streamoff>(at));
      file_.read(window_.data(), static_cast<std::streamsize>(window_.size()));
      if (!file_) window_.clear();
    }
    return window_.empty() ? std::string() : window_.substr(static_cast<std::size_t>(at - window_at_), n);
  }

 private:
  // Read at once, since a file may consist of a great many empty chunks.
  static constexpr std::uint64_t kWindowBytes = 4096;

  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t window_at_ = 0;
  std::string window_;
};

std::uint64_t LittleEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (auto it = bytes.rbegin(); it != bytes.rend(); ++it)
    value = value * 256 + static_cast<unsigned char>(*it);
  return value;
}

std::uint64_t BigEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) value = value * 256 + static_cast<unsigned char>(byte);
  return value;
}

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool IsLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

// "00dc", "01wb" and the like: a stream's data.
bool IsStreamChunk(std::string_view type) {
  return type.size() == 4 && IsDigit(type[0]) && IsDigit(type[1]) && IsLetter(type[2]) && IsLetter(type[3]);
}

bool IsPicture(std::string_view type) {
  return IsStreamChunk(type) && (type.ends_with("dc") || type.ends_with("db"));
}

// Whether a chunk's type may have these characters.
bool IsText(std::string_view type) {
  return std::all_of(type.begin(), type.end(),
                     [](char c) { return IsDigit(c) || IsLetter(c) || c == ' ' || c == '_'; });
}

// A hole of zeros: space that was reserved and never written.
bool IsHole(ByteReader& reader, std::uint64_t at) {
  constexpr std::size_t kHoleBytes = 64;
  return reader.At(at, kHoleBytes) == std::string(kHoleBytes, '\0');
}

// Looks among the frames for a hole, or for bytes that are no chunk.
std::optional<ContainerDamage> FindBreak(ByteReader& reader, std::uint64_t begin, std::uint64_t end) {
  std::int64_t pictures = 0;
  for (std::uint64_t at = begin; at + kHeaderBytes <= end;) {
    const std::string header = reader.At(at, kHeaderBytes);
    if (header.empty()) break;
    const bool is_zero = header == std::string(kHeaderBytes, '\0');
    if (is_zero && IsHole(reader, at)) return ContainerDamage{at, at, std::nullopt};
    const std::string_view type = std::string_view(header).substr(0, 4);
    const std::uint64_t size = LittleEndian(std::string_view(header).substr(4));
    const std::uint64_t next = at + kHeaderBytes + size;
    if ((!is_zero && !IsText(type)) || next > end + kHeaderBytes) return ContainerDamage{at, at, pictures};
    pictures += IsPicture(type) ? 1 : 0;
    // Odd chunks are padded, but not by every writer.
    at = next + (size % 2 == 1 && !IsStreamChunk(reader.At(next, 4)) ? 1 : 0);
  }
  return std::nullopt;
}

// Checks one RIFF chunk, from `begin` to `end`.
std::optional<ContainerDamage> CheckRiff(ByteReader& reader, std::uint64_t begin, std::uint64_t end) {
  constexpr std::uint64_t kFormTypeBytes = 4;
  std::uint64_t at = begin + kHeaderBytes + kFormTypeBytes;
  while (at + kHeaderBytes <= end && at + kHeaderBytes <= reader.size()) {
    const std::string header = reader.At(at, kHeaderBytes + kFormTypeBytes);
    if (header.empty()) break;
    if (IsHole(reader, at)) return ContainerDamage{at, at, std::nullopt};
    const std::uint64_t size = LittleEndian(std::string_view(header).substr(4, 4));
    const std::uint64_t next = at + kHeaderBytes + size;
    if (next > reader.size()) return ContainerDamage{reader.size(), std::max(next, end), std::nullopt};
    if (header.starts_with("LIST") && header.ends_with("movi")) {
      if (const auto damage = FindBreak(reader, at + kHeaderBytes + kFormTypeBytes, next)) return damage;
    }
    at = next + size % 2;
  }
  if (end > reader.size() + kHeaderBytes) return ContainerDamage{reader.size(), end, std::nullopt};
  return std::nullopt;
}

std::optional<ContainerDamage> CheckAvi(ByteReader& reader) {
  for (std::uint64_t at = 0; reader.At(at, 4) == "RIFF";) {
    const std::string header = reader.At(at, kHeaderBytes);
    if (header.empty()) return ContainerDamage{reader.size(), at + kHeaderBytes, std::nullopt};
    const std::uint64_t size = LittleEndian(std::string_view(header).substr(4));
    if (const std::string form = reader.At(at + kHeaderBytes, 4); form != "AVI " && form != "AVIX") {
      return std::nullopt;  // a recorder's notes after the footage, in a form of its own
    }
    if (size == 0 || size == 0xFFFFFFFFU) return std::nullopt;  // a stream: its writer left the size open
    if (const auto damage = CheckRiff(reader, at, at + kHeaderBytes + size)) return damage;
    at += kHeaderBytes + size + size % 2;
  }
  return std::nullopt;
}

std::optional<ContainerDamage> CheckMp4(ByteReader& reader) {
  for (std::uint64_t at = 0; at < reader.size();) {
    const std::string header = reader.At(at, kHeaderBytes);
    if (header.empty()) return ContainerDamage{reader.size(), at + kHeaderBytes, std::nullopt};
    std::uint64_t size = BigEndian(std::string_view(header).substr(0, 4));
    if (size == 0) return std::nullopt;  // this box goes on to the end of the file, wherever that is
    if (size == 1) size = BigEndian(reader.At(at + kHeaderBytes, 8));
    if (size < kHeaderBytes) return ContainerDamage{at, at, std::nullopt};
    if (at + size > reader.size()) return ContainerDamage{reader.size(), at + size, std::nullopt};
    at += size;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ContainerDamage> FindContainerDamage(const std::filesystem::path& path) {
  ByteReader reader(path);
  const std::string start = reader.At(0, 12);
  if (start.starts_with("RIFF") && start.ends_with("AVI ")) return CheckAvi(reader);
  if (start.substr(0, start.size() < 8 ? 0 : 8).ends_with("ftyp")) return CheckMp4(reader);
  return std::nullopt;
}

}  // namespace elbowroom::recon
