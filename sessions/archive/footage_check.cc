#include "sessions/archive/footage_check.h"

#include <fmt/format.h>

#include <system_error>

#include "core/system/file_hash.h"
#include "core/system/file_sync.h"

namespace elbowroom::sessions {

std::filesystem::path FootagePath(const std::filesystem::path& session, const core::FootageFile& file) {
  return (core::FolderOf(session) / file.file).lexically_normal();
}

std::optional<std::string> FootageProblem(const std::filesystem::path& session, const core::FootageFile& file,
                                          const std::stop_token& stop) {
  const std::filesystem::path path = FootagePath(session, file);
  std::error_code ignored;
  std::string wrong;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    wrong = "isn't there; put it back";
  } else if (static_cast<std::int64_t>(std::filesystem::file_size(path, ignored)) != file.bytes ||
             core::HashOfFile(path, stop) != file.content_hash) {
    wrong = "isn't the one that was recorded; put that back";
  }
  if (wrong.empty()) return std::nullopt;
  return fmt::format("footage '{}' of session '{}' {}", path.string(), session.string(), wrong);
}

}  // namespace elbowroom::sessions
