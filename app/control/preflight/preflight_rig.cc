#include "app/control/preflight/preflight_rig.h"

#include <fmt/format.h>

#include <string>

#include "app/control/trial_file/trial_tables.h"
#include "core/error.h"
#include "recon/capture/rig_source.h"

namespace elbowroom::control {
namespace {

std::filesystem::path RigPathOf(const std::filesystem::path& file) {
  if (file.extension() != ".toml") return file;
  const TrialTables trial = ReadTrialTables(file);
  const auto rig = trial.table["rig"].value<std::string>();
  if (!rig) {
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format("{}: names no rig; a trial file has the line rig = \"RIG.yml\"", trial.file.string()));
  }
  return trial.file.parent_path() / *rig;
}

}  // namespace

PreflightRig ReadPreflightRig(const std::filesystem::path& file) {
  PreflightRig rig;
  rig.path = RigPathOf(file);
  rig.rig_file = recon::ReadRigFile(rig.path);
  rig.is_live = recon::IsLiveRig(rig.rig_file);
  return rig;
}

}  // namespace elbowroom::control
