// The pictures that a session's silhouettes come from, and the empty scenes to hold against them.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "core/progress.h"
#include "recon/rig_files/rig_file.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

struct SessionFootage {
  recon::RigFile rig_file;         // the session's cameras, in its order; sources of their pictures
  std::filesystem::path location;  // the RIG.yml that names them
  // Whether the session names the files, and their checksums are right. False: it names none, and they are
  // those that the user says.
  bool is_named = false;
  std::vector<std::string> new_backgrounds;  // in words, of each camera that has another one
  std::vector<std::string> warnings;
};

// The footage that the session names, checked to the last byte; where it names none, that of `rig`. Where
// both are there, the empty scenes are those that `rig` names. Empty: no rig is given. Throws:
// core::Error{kFile}: a file of the footage is missing, or isn't the recorded one; {kFormat}: there is
// nothing to take pictures from, or a camera of `rig` isn't there, or stands or sees otherwise than in the
// session; what recon::ReadRigFile throws; {kCancelled}.
[[nodiscard]] SessionFootage FindFootage(const sessions::SessionReader& recorded,
                                         const std::filesystem::path& rig, const core::Progress& progress,
                                         const std::stop_token& stop);

}  // namespace elbowroom::control
