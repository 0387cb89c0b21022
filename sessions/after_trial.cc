#include "sessions/after_trial.h"

#include <fmt/format.h>

#include "core/error.h"
#include "sessions/database/statement.h"
#include "sessions/ended_session.h"
#include "sessions/event_rows.h"
#include "sessions/header_rows.h"

namespace elbowroom::sessions {

void AddAfterTrial(const std::filesystem::path& session, std::span<const core::EventContent> events) {
  AddToSession(session, "what is said after the trial can be added", [&](Database& database) {
    const core::SessionHeader header = ReadHeader(database);
    Statement last(database, "SELECT frame_index, time_s FROM frame ORDER BY frame_index DESC LIMIT 1");
    if (!last.Next())
      throw core::Error(
          core::ErrorKind::kRange,
          fmt::format("session '{}' has no frame; nothing can be added to it", session.string()));
    for (const core::EventContent& what : events)
      InsertEvent(database, header, {last.Integer(0), last.Real(1), what});
  });
}

}  // namespace elbowroom::sessions
