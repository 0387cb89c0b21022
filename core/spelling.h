// Words as people write them: misspelt, in capitals.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace elbowroom::core {

// The known word with the fewest edits to `word`. Nothing if these are more than a third of its letters and
// more than one.
[[nodiscard]] std::optional<std::string_view> NearestWord(std::string_view word,
                                                          std::span<const std::string_view> known);

// "did you mean 'known'?" with the nearest word, or `otherwise`.
[[nodiscard]] std::string SpellingAdvice(std::string_view word, std::span<const std::string_view> known,
                                         std::string_view otherwise);
[[nodiscard]] std::string SpellingAdvice(std::string_view word, std::span<const std::string> known,
                                         std::string_view otherwise);

// With small letters for the capitals of ASCII; other bytes stay.
[[nodiscard]] std::string LowerCase(std::string_view text);

}  // namespace elbowroom::core
