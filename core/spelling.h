// The word that a misspelt key was probably meant to be.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace elbowroom::core {

// The known word with the fewest edits to `word`. Nothing if these are more than a third of its letters and
// more than one.
[[nodiscard]] std::optional<std::string_view> NearestWord(std::string_view word,
                                                          std::span<const std::string_view> known);

}  // namespace elbowroom::core
