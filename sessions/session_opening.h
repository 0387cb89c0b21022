// A session's files, in whatever state they were left, as one database to read.
#pragma once

#include <filesystem>

#include "sessions/database/database.h"

namespace elbowroom::sessions {

struct OpenedSession {
  Database database;
  bool is_in_use = false;  // by its writer, or another reader, when it was opened
};

// Opens a session to be read. After a crash it is recovered and its spill is merged into it: in the files
// themselves where nobody uses them and they may be written, else in a private copy. While the session is in
// use its spill is left alone, because the writer merges it. A spill beside a complete session is ignored.
// Throws: Error{kFile} when there is no such file, or when the file at the spill's place isn't this
// session's; Error{kFormat} where the session is damaged; DatabaseError.
[[nodiscard]] OpenedSession OpenSession(const std::filesystem::path& path);

}  // namespace elbowroom::sessions
