// The bytes of a file, without a copy of them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

namespace elbowroom::cad_import {

// The file must not be shortened while this lives: reading beyond its new end is a crash.
class MappedFile {
 public:
  // Nothing: it can't be opened or holds nothing.
  [[nodiscard]] static std::optional<MappedFile> At(const std::filesystem::path& path);
  // Maps an open file. The descriptor may be closed afterwards.
  [[nodiscard]] static std::optional<MappedFile> Of(int descriptor);

  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::span<const std::byte> bytes_;
};

}  // namespace elbowroom::cad_import
