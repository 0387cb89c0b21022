// The tables of a session file that was found whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>

#include "sessions/database/database.h"
#include "sessions/database/query_limit.h"
#include "sessions/session_opening.h"

namespace elbowroom::sessions {

// Only reads, except that opening puts right what a crash left (OpenSession). The tables are those of the
// newest schema: a file of an older one is migrated in memory. Not movable: the limit holds the database.
class SoundSession {
 public:
  // Checks the whole file. Throws: what SessionReader throws when it opens a file.
  explicit SoundSession(const std::filesystem::path& path, const std::stop_token& stop = {});
  SoundSession(const SoundSession&) = delete;
  SoundSession& operator=(const SoundSession&) = delete;

  [[nodiscard]] Database& database() { return opened_.database; }
  [[nodiscard]] const QueryLimit& limit() const { return limit_; }
  [[nodiscard]] bool is_in_use() const {
    return opened_.is_in_use;
  }                                                              // by another program, when it was opened
  [[nodiscard]] std::int64_t schema() const { return schema_; }  // of the file

 private:
  void Check(const std::stop_token& stop);

  OpenedSession opened_;
  QueryLimit limit_;
  std::int64_t schema_ = 0;
};

}  // namespace elbowroom::sessions
