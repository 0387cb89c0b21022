// Adds what participants and experimenters say after a trial to its session.
#pragma once

#include <filesystem>
#include <span>

#include "core/session.h"

namespace elbowroom::sessions {

// Appends the events with the last frame's number and time: all or none, on the disk afterwards. What they
// name is of the session's set-up. The session has a frame, is sound, and isn't open in this program. Throws:
// what AddToSession throws; Error{kRange} if the session has no frame; PreconditionError.
void AddAfterTrial(const std::filesystem::path& session, std::span<const core::EventContent> events);

}  // namespace elbowroom::sessions
