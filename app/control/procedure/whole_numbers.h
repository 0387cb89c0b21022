// Whole numbers and scales in files.
#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "cad_import/layout/toml_entry.h"

namespace elbowroom::control {

// Nothing where the node holds anything but a whole number from `least` to `most`.
[[nodiscard]] std::optional<int> WholeNumber(const toml::node& node, int least, int most);

// The ends of the key `scale`, the least first; nothing: the key is absent. Throws: Error{kFormat} unless
// they are two whole numbers.
[[nodiscard]] std::optional<std::pair<int, int>> ReadScaleEnds(const cad_import::TomlEntry& entry);

}  // namespace elbowroom::control
