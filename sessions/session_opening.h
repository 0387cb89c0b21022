// A session's files, in whatever state they were left, as one database to read.
#pragma once

#include <filesystem>

#include "sessions/database.h"

namespace elbowroom::sessions {

struct OpenedSession {
  Database database;
  bool is_in_use = false;  // by its writer, or another reader, when it was opened
};

// What a crash left half done is put right, and a spill joins the session: in the files where nobody uses
// them and they may be written, else in a private copy. While the session is in use its spill is left alone:
// the writer merges it. Beside a complete session a spill is nobody's business. Throws: Error{kFile} when
// there is no such file, or what lies at the spill's place isn't this session's; Error{kFormat} where the
// session is damaged; DatabaseError.
[[nodiscard]] OpenedSession OpenSession(const std::filesystem::path& path);

}  // namespace elbowroom::sessions
