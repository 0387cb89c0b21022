// What a misspelt key was probably meant to be.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace elbowroom::core {

// The known word that `word` is fewest edits away from, if those are few (a third of its letters).
[[nodiscard]] std::optional<std::string_view> NearestWord(std::string_view word,
                                                          std::span<const std::string_view> known);

}  // namespace elbowroom::core
