// Whether the footage beside a session is the one that was recorded.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "core/session.h"

namespace elbowroom::sessions {

// Where a file of that session's footage should be.
[[nodiscard]] std::filesystem::path FootagePath(const std::filesystem::path& session,
                                                const core::FootageFile& file);

// What is wrong with it, one line that names it; nothing: it is there, and has its checksum. Reads all of
// it. Throws: core::Error{kFile} if it can't be read; {kCancelled}.
[[nodiscard]] std::optional<std::string> FootageProblem(const std::filesystem::path& session,
                                                        const core::FootageFile& file,
                                                        const std::stop_token& stop);

}  // namespace elbowroom::sessions
