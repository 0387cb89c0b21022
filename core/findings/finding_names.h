// How people name touches and near misses.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "core/findings/finding.h"

namespace elbowroom::core {

// "touch 3", "near miss 2"; of one that isn't in its session: "touch", "near miss".
[[nodiscard]] std::string NameOf(const Finding& finding);

// The first characters of an id that lists show.
inline constexpr std::size_t kShownIdLength = 8;

// The finding that `text` names: its id, or the beginning of it (four characters or more, of no other
// finding), or what NameOf() says; a number alone is a touch's. Throws: Error{kRange} where it names none, or
// several.
[[nodiscard]] const Finding& FindFinding(std::span<const Finding> findings, std::string_view text);

}  // namespace elbowroom::core
