// Sessions of people who don't exist, so that nobody takes them for a person's.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>
#include <variant>

#include "core/session.h"

namespace elbowroom::core {

// A note of such a session begins with it; what the motion was drawn from follows.
inline constexpr std::string_view kSimulatedNote = "simulated: ";

[[nodiscard]] inline bool IsSimulated(std::span<const SessionEvent> events) {
  return std::ranges::any_of(events, [](const SessionEvent& event) {
    const auto* note = std::get_if<Note>(&event.what);
    return note != nullptr && note->text.starts_with(kSimulatedNote);
  });
}

}  // namespace elbowroom::core
