// Ends queries that take too long: those of a hostile or damaged file, and those that were cancelled.
#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>

#include "sessions/database/database.h"

namespace elbowroom::sessions {

// How many steps of SQLite's virtual machine one statement may take on a file of that many bytes. The most
// expensive statement on a sound session, its integrity check, takes less than 1 step a byte
// (damaged_session_test).
[[nodiscard]] std::int64_t MostStepsFor(std::int64_t file_bytes);

// While it lives, a statement of the connection fails with SQLITE_INTERRUPT when it takes more steps than
// MostStepsFor() allows for the file, or when `stop` is requested while it runs.
class QueryLimit {
 public:
  QueryLimit(Database& database, std::stop_token stop);
  ~QueryLimit();
  QueryLimit(QueryLimit&&) noexcept;
  QueryLimit& operator=(QueryLimit&& other) noexcept;

  // Returns what `work` returns. Where a statement in it was ended, throws Error{kFormat} if it took too many
  // steps, Error{kCancelled} if a stop was requested.
  template <typename Work>
  auto Guarded(Work&& work) const {
    try {
      return work();
    } catch (const core::Error& error) {
      if (error.kind() == core::ErrorKind::kDatabase) ThrowIfEnded();
      throw;
    }
  }

  // Taken by the most expensive statement so far, to within some thousands.
  [[nodiscard]] std::int64_t most_steps_taken() const;

 private:
  void ThrowIfEnded() const;

  struct Count;
  std::unique_ptr<Count> count_;
};

}  // namespace elbowroom::sessions
