#include "sessions/session_opening.h"

#include <memory>

#include "sessions/private_copy.h"
#include "sessions/session_files.h"
#include "sessions/spill.h"

namespace elbowroom::sessions {
namespace {

void MergeSpillOf(const std::filesystem::path& path) {
  Database session = Database::OpenToWrite(path);
  MergeSpill(session);
  session.FoldLogIntoFile();
}

}  // namespace

OpenedSession OpenSession(const std::filesystem::path& path) {
  const bool is_in_use = IsInUse(path);
  if (is_in_use || !HasSpill(path) || !std::filesystem::is_regular_file(path))
    return {Database::OpenReadOnly(path), is_in_use};
  try {
    MergeSpillOf(path);
    return {Database::OpenReadOnly(path), false};
  } catch (const DatabaseError&) {
    // Locked, or not to be written: the copy is neither.
  }
  auto copy = std::make_shared<const PrivateCopy>(path);
  // Another reader may have joined the two meanwhile.
  if (HasSpill(copy->path())) MergeSpillOf(copy->path());
  return {Database::OpenReadOnly(std::move(copy)), false};
}

}  // namespace elbowroom::sessions
