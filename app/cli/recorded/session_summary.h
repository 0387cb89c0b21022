// What `sessions show` tells of a session.
#pragma once

#include "app/cli/options/command.h"
#include "sessions/session_reader.h"

namespace elbowroom::cli {

[[nodiscard]] nlohmann::json SummaryJson(const sessions::SessionReader& session);

// The same for people, in some lines.
[[nodiscard]] std::string SummaryText(const nlohmann::json& summary);

}  // namespace elbowroom::cli
