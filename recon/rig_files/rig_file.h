// RIG.yml and VIEW.yml: a rig's calibration and where its cameras' pictures come from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"

namespace elbowroom::recon {

// Absolute paths (in RIG.yml they are relative to it), or "device:N", or a URL; empty = absent.
struct CameraSources {
  std::string frames;
  std::string background;
  std::string masks;

  [[nodiscard]] bool operator==(const CameraSources&) const = default;
};

struct RigFile {
  core::Rig rig;
  std::vector<CameraSources> sources;  // one a camera
};

// Matrices may be !!opencv-matrix, a flat list, or a list of rows. Throws: Error{kFile} if it can't be read,
// Error{kFormat} for a missing or wrong key, Error{kRange} for a workspace that is empty or too large,
// Error{kCamera} for a camera that can't exist (singular matrix, no rotation, wrong number of coefficients).
// All name the file, and the camera and the key where there is one.
[[nodiscard]] RigFile ReadRigFile(const std::filesystem::path& path);

// What VIEW.yml says.
struct ViewFile {
  core::CameraModel camera;
  // Rays run along the camera's z axis, and camera_matrix maps (X, Y, 1), in mm, to pixels.
  bool is_orthographic = false;
};

// Reads one camera. Its keys stand at the top level, below `camera`, or in the only element of `cameras`.
// Beside them may stand `projection`: "perspective" (default) or "orthographic". An orthographic camera has
// no distortion, and the keys for it may be absent. Throws: as ReadRigFile; Error{kFormat} also for a picture
// of more than 40 million pixels.
[[nodiscard]] ViewFile ReadViewFile(const std::filesystem::path& path);

// Writes the whole file or nothing; every number reads back exactly. Sources below the file's folder become
// relative to it. Throws: Error{kFile}; PreconditionError unless `sources` has one entry a camera.
void WriteRigFile(const RigFile& rig_file, const std::filesystem::path& path);

}  // namespace elbowroom::recon
