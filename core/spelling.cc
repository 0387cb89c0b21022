#include "core/spelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace elbowroom::core {
namespace {

// The Levenshtein distance: how many letters must be inserted, deleted or replaced.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string_view> NearestWord(std::string_view word, std::span<const std::string_view> known) {
  std::optional<std::string_view> nearest;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3);
  for (const std::string_view candidate : known) {
    const std::size_t edits = EditDistance(word, candidate);
    if (edits < fewest || (edits == fewest && !nearest)) {
      nearest = candidate;
      fewest = edits;
    }
  }
  return nearest;
}

std::string SpellingAdvice(std::string_view word, std::span<const std::string_view> known,
                           std::string_view otherwise) {
  const auto nearest = NearestWord(word, known);
  return nearest ? fmt::format("did you mean '{}'?", *nearest) : std::string(otherwise);
}

std::string SpellingAdvice(std::string_view word, std::span<const std::string> known,
                           std::string_view otherwise) {
  const std::vector<std::string_view> words(known.begin(), known.end());
  return SpellingAdvice(word, words, otherwise);
}

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

}  // namespace elbowroom::core
