// What an entry of a LAYOUT.toml says, key by key, as it is written.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/layout.h"

namespace elbowroom::cad_import {

using FieldValue = std::variant<bool, double, std::string, Eigen::Vector3d, std::vector<std::string>>;

struct Field {
  std::string key;
  FieldValue value;

  [[nodiscard]] bool operator==(const Field&) const = default;
};
using Fields = std::vector<Field>;  // in the order in which they are written

// The kinds of entries that make up a core::Layout, in the order in which a file has them.
inline constexpr std::array<std::string_view, 5> kEntryKinds{"part", "group", "spacing", "pair", "stream"};

// All that a file may have at its top.
inline constexpr std::array<std::string_view, 7> kLayoutKeys{"unit", "part",   "group",  "spacing",
                                                             "pair", "stream", "section"};

// The keys that an entry [[kind]] may have, in the order in which they are written. Throws: PreconditionError
// for a kind that isn't among kLayoutKeys.
[[nodiscard]] std::span<const std::string_view> KeysOf(std::string_view kind);

// The fields of each entry [[kind]], in the layout's order. Throws: Error{kCad} naming a part without a file;
// PreconditionError for a kind that isn't among kEntryKinds.
[[nodiscard]] std::vector<Fields> FieldsOf(const core::Layout& layout, std::string_view kind);

// Null where there is none.
[[nodiscard]] const FieldValue* FindField(const Fields& fields, std::string_view key);

// As TOML has it: 12.0, "in", [1.0, 2.0, 3.0]; numbers come back the same.
[[nodiscard]] std::string TomlOf(const FieldValue& value);

}  // namespace elbowroom::cad_import
