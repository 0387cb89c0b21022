// A rig that another program calibrated, made a RIG.yml.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/calibration/calibration_file.h"
#include "app/control/calibration/foreign_check.h"
#include "core/progress.h"
#include "recon/rig_files/foreign_rig.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

struct RigImportOptions {
  std::vector<std::filesystem::path> files;
  std::optional<recon::ForeignFormat> format;  // nothing: told by the files
  StatedConvention stated;
  Eigen::Vector3d up_in_file = Eigen::Vector3d::UnitZ();  // an axis that points up; without a check only
  std::optional<std::array<int, 2>> size_px;              // of all cameras whose file doesn't say it
  // Nothing: the check's; else a cube around where the cameras look.
  std::optional<Eigen::AlignedBox3d> workspace_mm;
};

struct RigImport {
  recon::ForeignFormat format = recon::ForeignFormat::kOpenCv;
  FoundConvention found;
  std::vector<std::string> warnings;
  recon::RigFile rig_file;
};

// Takes the convention that is stated or documented. The world is the file's, turned so that z is up. Throws:
// what ReadForeignFiles and UncheckedConvention throw; Error{kCamera} for a camera without pose, size or
// possible lens, or cameras that all stand in one place; Error{kRange} if the workspace can't be guessed.
[[nodiscard]] RigImport ImportRig(const RigImportOptions& options, const std::string& rig_name);

// Finds the convention and the unit by the board in the footage of `check`, whose cameras, world and
// workspace the rig gets. Cameras are matched by name, or in order if no name fits. Throws: also what
// FindBoards, ViewsOf and FindConvention throw; Error{kCamera} for cameras that don't match, sizes that
// differ, or a world that the board doesn't decide; Error{kCancelled}.
[[nodiscard]] RigImport ImportCheckedRig(const RigImportOptions& options, const CalibrationFile& check,
                                         const std::string& rig_name, const core::Progress& progress,
                                         const std::stop_token& stop);

}  // namespace elbowroom::control
