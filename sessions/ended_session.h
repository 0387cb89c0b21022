// Adds to a session's file after its trial.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "sessions/database/database.h"

namespace elbowroom::sessions {

// Runs `add` in one transaction: all is on the disk afterwards, or nothing. A file of an older schema gets
// the newest one in the same step. The file must be sound (SessionReader), and this program must not have it
// open. `until_then`: what has to wait for the end of the trial, for the message: "its touches can be
// reviewed". Throws: Error{kFile}: there is no such file, or it is being recorded; Error{kFormat}: it is no
// session; DatabaseError, naming the file, where it can't be written. The file is as it was then.
void AddToSession(const std::filesystem::path& session, std::string_view until_then,
                  const std::function<void(Database&)>& add);

}  // namespace elbowroom::sessions
