#include "cad_import/formats/glb_container.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "cad_import/formats/gltf_check.h"
#include "cad_import/formats/malformed_file.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

constexpr std::size_t kGlbHeaderBytes = 12, kChunkHeaderBytes = 8, kAlignment = 4;
constexpr std::size_t kTotalAt = 8, kJsonBytesAt = kGlbHeaderBytes,
                      kJsonAt = kGlbHeaderBytes + kChunkHeaderBytes;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

std::uint32_t WordAt(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void SetAt(std::string& bytes, std::size_t at, std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::size_t MissingBytes(std::size_t chunk_bytes) {
  return (kAlignment - chunk_bytes % kAlignment) % kAlignment;
}

// Where the second chunk begins, if there is one.
std::size_t SecondAt(std::string_view glb) {
  const std::size_t json_end = kJsonAt + WordAt(glb, kJsonBytesAt);
  return LacksPadding(glb) ? json_end : json_end + MissingBytes(json_end);
}

}  // namespace

void CheckGlb(std::string_view bytes, const std::string& where) {
  if (bytes.size() < kJsonAt || !bytes.starts_with("glTF")) {
    FailUntilExportedAgain(where, "not a GLB file (it doesn't start with \"glTF\"), or cut off");
  }
  if (WordAt(bytes, 4) != 2)
    FailUntilExportedAgain(where, fmt::format("GLB version {} can't be read, only 2", WordAt(bytes, 4)));
  if (WordAt(bytes, kTotalAt) > bytes.size()) {
    FailUntilExportedAgain(where,
                           fmt::format("the GLB header claims {} bytes but the file holds {}: it is cut off",
                                       WordAt(bytes, kTotalAt), bytes.size()));
  }
  const std::size_t json_bytes = WordAt(bytes, kJsonBytesAt);
  if (WordAt(bytes, kJsonBytesAt + 4) != kJsonChunk || json_bytes > bytes.size() - kJsonAt) {
    FailUntilExportedAgain(where, "the GLB file's first chunk is not whole JSON");
  }
  const std::size_t second_at = SecondAt(bytes);
  if (second_at + kChunkHeaderBytes <= bytes.size() &&
      WordAt(bytes, second_at) > bytes.size() - second_at - kChunkHeaderBytes) {
    FailUntilExportedAgain(where, "the GLB file's second chunk runs past its end: it is cut off");
  }
  CheckGltf(bytes.substr(kJsonAt, json_bytes), where);
}

bool LacksPadding(std::string_view glb) {
  const std::size_t json_end = kJsonAt + WordAt(glb, kJsonBytesAt);
  return MissingBytes(json_end) > 0 && json_end + kChunkHeaderBytes <= glb.size() &&
         WordAt(glb, json_end + 4) == kBinaryChunk;
}

std::string_view JsonOf(std::string_view glb) { return glb.substr(kJsonAt, WordAt(glb, kJsonBytesAt)); }

std::string Padded(std::string glb) {
  const std::string json(JsonOf(glb));
  return WithJson(std::move(glb), json);
}

std::string MakeGlb(const std::string& json, std::string_view buffer) {
  std::string glb("glTF");
  glb.resize(kJsonAt, '\0');
  SetAt(glb, 4, 2);
  SetAt(glb, kJsonBytesAt + 4, kJsonChunk);
  glb += json;
  glb.resize(glb.size() + MissingBytes(glb.size()), ' ');
  SetAt(glb, kJsonBytesAt, glb.size() - kJsonAt);
  const std::size_t chunk_at = glb.size(), buffer_bytes = buffer.size() + MissingBytes(buffer.size());
  if (chunk_at + kChunkHeaderBytes + buffer_bytes > std::numeric_limits<std::uint32_t>::max())
    throw core::Error(core::ErrorKind::kRange,
                      "a GLB file holds at most 4 GiB; choose a coarser mesh or .ply");
  glb.resize(chunk_at + kChunkHeaderBytes, '\0');
  SetAt(glb, chunk_at, buffer_bytes);
  SetAt(glb, chunk_at + 4, kBinaryChunk);
  glb += buffer;
  glb.resize(chunk_at + kChunkHeaderBytes + buffer_bytes, '\0');
  SetAt(glb, kTotalAt, glb.size());
  return glb;
}

std::string WithJson(std::string glb, const std::string& json) {
  const std::size_t before = WordAt(glb, kJsonBytesAt);
  const std::string padded = json + std::string(MissingBytes(kJsonAt + json.size()), ' ');
  SetAt(glb, kTotalAt, WordAt(glb, kTotalAt) - before + padded.size());
  SetAt(glb, kJsonBytesAt, padded.size());
  glb.replace(kJsonAt, before, padded);
  return glb;
}

}  // namespace elbowroom::cad_import
