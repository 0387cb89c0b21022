// Ends what would never end: a query of a hostile or damaged file, or one that nobody waits for any more.
#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>

#include "sessions/database.h"

namespace elbowroom::sessions {

// Steps of SQLite's machine that one statement may take on a file of that many bytes. Of a sound session the
// dearest, its integrity check, takes less than 1 step a byte (damaged_session_test).
[[nodiscard]] std::int64_t MostStepsFor(std::int64_t file_bytes);

// While it lives, a statement of the connection that takes more steps than its file has reason for fails with
// SQLITE_INTERRUPT, and so does one that is under way when `stop` is asked for.
class QueryLimit {
 public:
  QueryLimit(Database& database, std::stop_token stop);
  ~QueryLimit();
  QueryLimit(QueryLimit&&) noexcept;
  QueryLimit& operator=(QueryLimit&& other) noexcept;

  // What `work` returns. Where a statement in it was ended, throws Error{kFormat} if for its length,
  // Error{kCancelled} if for the stop.
  template <typename Work>
  auto Guarded(Work&& work) const {
    try {
      return work();
    } catch (const core::Error& error) {
      if (error.kind() == core::ErrorKind::kDatabase) ThrowIfEnded();
      throw;
    }
  }

  // By the dearest statement so far, to some thousands.
  [[nodiscard]] std::int64_t most_steps_taken() const;

 private:
  void ThrowIfEnded() const;

  struct Count;
  std::unique_ptr<Count> count_;
};

}  // namespace elbowroom::sessions
