#include "cad_import/gltf_check.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using nlohmann::json;

constexpr int kDeepestNesting = 256;

[[noreturn]] void Fail(const std::string& where, const std::string& what) {
  throw core::Error(core::ErrorKind::kFormat, fmt::format("{}: {}; export it again", where, what));
}

// A member that must be a non-negative integer where it is present.
std::uint64_t CountAt(const json& object, const char* key, std::uint64_t fallback, const std::string& where) {
  if (!object.is_object() || !object.contains(key)) return fallback;
  const json& value = object.at(key);
  if (!value.is_number_unsigned()) Fail(where, fmt::format("the glTF key '{}' is not a count", key));
  return value.get<std::uint64_t>();
}

const json& ListAt(const json& document, const char* key) {
  static const json kNone = json::array();
  return document.contains(key) && document.at(key).is_array() ? document.at(key) : kNone;
}

std::uint64_t ElementBytes(const json& accessor, const std::string& where) {
  const std::uint64_t component = CountAt(accessor, "componentType", 0, where);
  const std::uint64_t component_bytes = component <= 5121 ? 1 : component <= 5123 ? 2 : 4;
  const std::string type = accessor.value("type", "");
  const std::uint64_t components = type == "VEC2"                     ? 2
                                   : type == "VEC3"                   ? 3
                                   : type == "VEC4" || type == "MAT2" ? 4
                                   : type == "MAT3"                   ? 9
                                   : type == "MAT4"                   ? 16
                                                                      : 1;
  return component_bytes * components;
}

void CheckViews(const json& document, const std::string& where) {
  const json& buffers = ListAt(document, "buffers");
  const json& views = ListAt(document, "bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::uint64_t buffer = CountAt(views[i], "buffer", 0, where);
    if (buffer >= buffers.size()) Fail(where, fmt::format("glTF buffer view {} names no buffer", i));
    const std::uint64_t buffer_bytes = CountAt(buffers[buffer], "byteLength", 0, where);
    const std::uint64_t offset = CountAt(views[i], "byteOffset", 0, where);
    const std::uint64_t length = CountAt(views[i], "byteLength", 0, where);
    if (offset > buffer_bytes || length > buffer_bytes - offset) {
      Fail(where, fmt::format("glTF buffer view {} runs past its buffer", i));
    }
  }
}

void CheckAccessors(const json& document, const std::string& where) {
  const json& views = ListAt(document, "bufferViews");
  const json& accessors = ListAt(document, "accessors");
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    const std::uint64_t count = CountAt(accessors[i], "count", 0, where);
    if (count == 0 || !accessors[i].contains("bufferView")) continue;
    const std::uint64_t view = CountAt(accessors[i], "bufferView", 0, where);
    if (view >= views.size()) Fail(where, fmt::format("glTF accessor {} names no buffer view", i));
    const std::uint64_t element_bytes = ElementBytes(accessors[i], where);
    const std::uint64_t stride = CountAt(views[view], "byteStride", element_bytes, where);
    const std::uint64_t length = CountAt(views[view], "byteLength", 0, where);
    const std::uint64_t offset = CountAt(accessors[i], "byteOffset", 0, where);
    const bool fits = offset <= length && element_bytes <= length - offset &&
                      (stride == 0 || count - 1 <= (length - offset - element_bytes) / stride);
    if (!fits)
      Fail(where,
           fmt::format("glTF accessor {} claims {} elements, more than its buffer view holds", i, count));
  }
}

// Every node has at most one parent and no node hangs on itself, so the depth of each is well defined.
void CheckNodes(const json& document, const std::string& where) {
  const json& nodes = ListAt(document, "nodes");
  std::vector<std::optional<std::size_t>> parent(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].is_object()) Fail(where, fmt::format("glTF node {} is not an object", i));
    for (const json& child : ListAt(nodes[i], "children")) {
      if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= nodes.size()) {
        Fail(where, fmt::format("glTF node {} has a child that doesn't exist", i));
      }
      auto& childs_parent = parent[child.get<std::size_t>()];
      if (childs_parent) Fail(where, fmt::format("glTF node {} has two parents", child.get<std::size_t>()));
      childs_parent = i;
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    int depth = 0;
    for (auto up = parent[i]; up; up = parent[*up]) {
      if (++depth > kDeepestNesting) {
        Fail(where,
             fmt::format("glTF node {} is its own ancestor or nested deeper than {}", i, kDeepestNesting));
      }
    }
  }
}

std::uint32_t WordAt(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

void CheckGltf(std::string_view json_text, const std::string& where) try {
  const json document = json::parse(json_text, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) Fail(where, "not a glTF file, or cut off (its JSON doesn't parse)");
  const json asset = document.value("asset", json::object());
  const std::string version = asset.is_object() && asset.contains("version") && asset["version"].is_string()
                                  ? asset["version"].get<std::string>()
                                  : "";
  if (!version.starts_with("2."))
    Fail(where, fmt::format("glTF version '{}' can't be read, only 2.0", version));
  CheckViews(document, where);
  CheckAccessors(document, where);
  CheckNodes(document, where);
} catch (const json::exception&) {  // a value of another type than the specification says
  Fail(where, "the glTF document has a value of the wrong type");
}

void CheckGlb(std::string_view bytes, const std::string& where) {
  constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
  constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
  if (bytes.size() < kHeaderBytes + kChunkHeaderBytes || !bytes.starts_with("glTF")) {
    Fail(where, "not a GLB file (it doesn't start with \"glTF\"), or cut off");
  }
  if (WordAt(bytes, 4) != 2)
    Fail(where, fmt::format("GLB version {} can't be read, only 2", WordAt(bytes, 4)));
  if (WordAt(bytes, 8) > bytes.size()) {
    Fail(where, fmt::format("the GLB header claims {} bytes but the file holds {}: it is cut off",
                            WordAt(bytes, 8), bytes.size()));
  }
  const std::size_t json_bytes = WordAt(bytes, kHeaderBytes);
  const std::size_t json_at = kHeaderBytes + kChunkHeaderBytes;
  if (WordAt(bytes, kHeaderBytes + 4) != kJsonChunk || json_bytes > bytes.size() - json_at) {
    Fail(where, "the GLB file's first chunk is not whole JSON");
  }
  if (json_bytes % 4 != 0) {
    Fail(where, "the GLB file's chunks don't end on multiples of 4 bytes, as its specification demands");
  }
  const std::size_t next_at = json_at + json_bytes;
  if (next_at + kChunkHeaderBytes <= bytes.size() &&
      WordAt(bytes, next_at) > bytes.size() - next_at - kChunkHeaderBytes) {
    Fail(where, "the GLB file's second chunk runs past its end: it is cut off");
  }
  CheckGltf(bytes.substr(json_at, json_bytes), where);
}

}  // namespace elbowroom::cad_import
