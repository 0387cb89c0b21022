// The files that a session may be made of: the database, what SQLite keeps beside it, and a spill.
#pragma once

#include <filesystem>
#include <string_view>

namespace elbowroom::sessions {

inline constexpr std::string_view kLogSuffix = "-wal";           // what was committed last
inline constexpr std::string_view kLogIndexSuffix = "-shm";      // the log's; made anew where it is missing
inline constexpr std::string_view kRollbackSuffix = "-journal";  // how to undo a change that was broken off
inline constexpr std::string_view kSpillSuffix = ".spill";       // frames that the session file couldn't take

[[nodiscard]] inline std::filesystem::path WithSuffix(std::filesystem::path path, std::string_view suffix) {
  path += suffix;
  return path;
}

}  // namespace elbowroom::sessions
