#include "cad_import/formats/gltf_check.h"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "cad_import/formats/malformed_file.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using nlohmann::json;

constexpr int kDeepestNesting = 256;

// A member that must be a non-negative integer where it is present.
std::uint64_t CountAt(const json& object, const char* key, std::uint64_t fallback, const std::string& where) {
  if (!object.is_object() || !object.contains(key)) return fallback;
  const json& value = object.at(key);
  if (!value.is_number_unsigned())
    FailUntilExportedAgain(where, fmt::format("the glTF key '{}' is not a count", key));
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
    if (buffer >= buffers.size())
      FailUntilExportedAgain(where, fmt::format("glTF buffer view {} names no buffer", i));
    const std::uint64_t buffer_bytes = CountAt(buffers[buffer], "byteLength", 0, where);
    const std::uint64_t offset = CountAt(views[i], "byteOffset", 0, where);
    const std::uint64_t length = CountAt(views[i], "byteLength", 0, where);
    if (offset > buffer_bytes || length > buffer_bytes - offset) {
      FailUntilExportedAgain(where, fmt::format("glTF buffer view {} runs past its buffer", i));
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
    if (view >= views.size())
      FailUntilExportedAgain(where, fmt::format("glTF accessor {} names no buffer view", i));
    const std::uint64_t element_bytes = ElementBytes(accessors[i], where);
    // Version 1.0 keeps the stride in the accessor, where 0 means that elements follow each other.
    const std::uint64_t own_stride = CountAt(accessors[i], "byteStride", 0, where);
    const std::uint64_t view_stride = CountAt(views[view], "byteStride", own_stride, where);
    const std::uint64_t stride = view_stride == 0 ? element_bytes : view_stride;
    const std::uint64_t length = CountAt(views[view], "byteLength", 0, where);
    const std::uint64_t offset = CountAt(accessors[i], "byteOffset", 0, where);
    const bool fits = offset <= length && element_bytes <= length - offset &&
                      count - 1 <= (length - offset - element_bytes) / stride;
    if (!fits)
      FailUntilExportedAgain(
          where,
          fmt::format("glTF accessor {} claims {} elements, more than its buffer view holds", i, count));
  }
}

// Every node has at most one parent and no node hangs on itself, so the depth of each is well defined.
void CheckNodes(const json& document, const std::string& where) {
  const json& nodes = ListAt(document, "nodes");
  std::vector<std::optional<std::size_t>> parent(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].is_object()) FailUntilExportedAgain(where, fmt::format("glTF node {} is not an object", i));
    for (const json& child : ListAt(nodes[i], "children")) {
      if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= nodes.size()) {
        FailUntilExportedAgain(where, fmt::format("glTF node {} has a child that doesn't exist", i));
      }
      auto& childs_parent = parent[child.get<std::size_t>()];
      if (childs_parent)
        FailUntilExportedAgain(where, fmt::format("glTF node {} has two parents", child.get<std::size_t>()));
      childs_parent = i;
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    int depth = 0;
    for (auto up = parent[i]; up; up = parent[*up]) {
      if (++depth > kDeepestNesting) {
        FailUntilExportedAgain(where, fmt::format("glTF node {} is its own ancestor or nested deeper than {}",
                                                  i, kDeepestNesting));
      }
    }
  }
}

// The numbers that version 2.0 would give to what version 1.0 keeps under names. An unknown name gets a
// number past the list's end.
class Numbers {
 public:
  explicit Numbers(const json& named) {
    for (const auto& item : named.items()) numbers_.emplace(item.key(), numbers_.size());
  }
  [[nodiscard]] json Of(const json& name) const {
    const auto found = name.is_string() ? numbers_.find(name.get<std::string>()) : numbers_.end();
    return found == numbers_.end() ? numbers_.size() : found->second;
  }

 private:
  std::map<std::string, std::size_t> numbers_;
};

json NamedIn(const json& document, const char* key) {
  json named = document.value(key, json::object());
  return named.is_object() ? named : json::object();
}

// The named entries at `key` as a list. In each entry the member `reference`, one name or several in
// `target`, is replaced by numbers.
json ListOf(const json& document, const char* key, const char* reference, const char* target) {
  const Numbers numbers(NamedIn(document, target));
  json list = json::array();
  for (json entry : NamedIn(document, key)) {
    if (entry.is_object() && entry.contains(reference)) {
      json& names = entry.at(reference);
      if (names.is_array()) {
        for (json& name : names) name = numbers.Of(name);
      } else {
        names = numbers.Of(names);
      }
    }
    list.push_back(std::move(entry));
  }
  return list;
}

// Buffers, views, accessors and nodes of version 1.0.
json AsVersion2(const json& document) {
  return {{"buffers", ListOf(document, "buffers", "", "")},
          {"bufferViews", ListOf(document, "bufferViews", "buffer", "buffers")},
          {"accessors", ListOf(document, "accessors", "bufferView", "bufferViews")},
          {"nodes", ListOf(document, "nodes", "children", "nodes")}};
}

// "1.0", "2.0", and in some of version 1 the number.
std::string VersionOf(const json& document) {
  const json asset = document.value("asset", json::object());
  if (!asset.is_object() || !asset.contains("version")) return "";
  const json& version = asset.at("version");
  return version.is_string() ? version.get<std::string>() : version.dump();
}

bool IsVersion(int major, const std::string& version) {
  const std::string text = fmt::format("{}", major);
  return version == text || version.starts_with(text + ".");
}

}  // namespace

void CheckGltf(std::string_view json_text, const std::string& where) try {
  json document = json::parse(json_text, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object())
    FailUntilExportedAgain(where, "not a glTF file, or cut off (its JSON doesn't parse)");
  const std::string version = VersionOf(document);
  if (IsVersion(1, version)) {
    document = AsVersion2(document);
  } else if (!IsVersion(2, version)) {
    FailUntilExportedAgain(where, fmt::format("glTF version '{}' can't be read, only 1.0 and 2.0", version));
  }
  CheckViews(document, where);
  CheckAccessors(document, where);
  CheckNodes(document, where);
} catch (const json::exception&) {  // a value of another type than the specification says
  FailUntilExportedAgain(where, "the glTF document has a value of the wrong type");
}

}  // namespace elbowroom::cad_import
