#include "sessions/review_editor.h"

#include "sessions/ended_session.h"
#include "sessions/finding_rows.h"

namespace elbowroom::sessions {

void AddRemarks(const std::filesystem::path& session, std::span<const FindingRemark> remarks) {
  AddToSession(session, "its touches can be reviewed", [&](Database& database) {
    for (const FindingRemark& said : remarks) InsertRemark(database, said.finding, said.remark);
  });
}

}  // namespace elbowroom::sessions
