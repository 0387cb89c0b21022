// A CadModel as bytes, which the child hands over and the cache keeps. Unpack checks them before they are
// used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cad_import/model/cad_model.h"

namespace elbowroom::cad_import {

// Another file that the parser opened, and what was in it.
struct ReferredFile {
  std::string path;  // relative to the folder of the file
  std::string hash;  // 32 hex digits, as HashOf
};

struct PackedModel {
  CadModel model;
  std::vector<ReferredFile> referred;
};

// Changes when the same file would give other bytes.
inline constexpr std::uint32_t kPackedModelVersion = 8;

// 128-bit XXH3, 32 hex digits.
[[nodiscard]] std::string HashOf(std::span<const std::byte> bytes);
// A hash of a file's content. Throws: Error{kFile} naming it if it can't be read.
[[nodiscard]] std::string HashOfFile(const std::filesystem::path& file);

// The checksum of all that follows it in the file: 64-bit XXH3.
[[nodiscard]] std::uint64_t ChecksumOf(std::span<const std::byte> payload);

[[nodiscard]] std::vector<std::byte> Pack(const CadModel& model, std::span<const ReferredFile> referred);

// Allocates no more than a few times the size of `bytes`. Throws: Error{kFormat} naming `where` unless magic,
// version, checksum and every length are right, meshes are valid, pieces cover their triangles, instances
// name shapes and are rigid, and the report's counts are those of the model.
[[nodiscard]] PackedModel Unpack(std::span<const std::byte> bytes, const std::string& where);

}  // namespace elbowroom::cad_import
