// Adds what reviewers say of touches and near misses to a session's file.
#pragma once

#include <filesystem>
#include <span>

#include "core/findings/finding.h"

namespace elbowroom::sessions {

struct FindingRemark {
  core::FindingId finding;
  core::ReviewRemark remark;
};

// Appends the remarks to those that the session has: all or none, on the disk afterwards. A file of an older
// schema gets the newest one in the same step. The file must be sound (SessionReader), and this program must
// not have it open.
// Throws: Error{kFile}: there is no such file, or it is being recorded; Error{kFormat}: it is no session;
// DatabaseError, naming the file, where it can't be written. The file is as it was then.
void AddRemarks(const std::filesystem::path& session, std::span<const FindingRemark> remarks);

}  // namespace elbowroom::sessions
