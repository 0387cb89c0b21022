// The rig that a trial will use, known without opening its cameras.
#pragma once

#include <filesystem>

#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

struct PreflightRig {
  std::filesystem::path path;  // of RIG.yml
  recon::RigFile rig_file;
  bool is_live = false;
};

// `file`: a TRIAL.toml (by its ending), or a RIG.yml. Throws: core::Error as ReadRigFile; Error{kFile},
// Error{kFormat} naming the trial file for one that can't be read or names no rig; Error{kFormat} for a rig
// of which only some cameras are live.
[[nodiscard]] PreflightRig ReadPreflightRig(const std::filesystem::path& file);

}  // namespace elbowroom::control
