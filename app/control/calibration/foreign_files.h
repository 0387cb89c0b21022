// Files in which other programs keep calibrations.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/camera_model.h"
#include "recon/rig_files/foreign_rig.h"

namespace elbowroom::control {

// The cameras of one or more files of one format, in the files' order. `format`: nothing: it is told by the
// files. Throws: Error{kFile} if one can't be read; Error{kFormat} and Error{kCamera} naming file and place.
[[nodiscard]] recon::ForeignRig ReadForeignFiles(std::span<const std::filesystem::path> files,
                                                 std::optional<recon::ForeignFormat> format);

// Size, camera matrix and lens of the camera `name`, or of the only one, in a file of any format that has
// lenses: RIG.yml and those of recon::ForeignFormat but 3 x 4 matrices. Width and height are 0 if the file
// doesn't say them. Throws: as ReadForeignFiles; Error{kCamera} if the file has several cameras, and none of
// that name, or a camera that can't exist.
[[nodiscard]] core::CameraCalibration ReadLensFile(const std::filesystem::path& file,
                                                   const std::string& name);

}  // namespace elbowroom::control
