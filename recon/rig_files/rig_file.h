// RIG.yml and VIEW.yml: a rig's calibration and where its cameras' pictures come from.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"
#include "core/rig_quality.h"
#include "recon/rig_files/capture_settings.h"

namespace elbowroom::recon {

// Absolute paths (in RIG.yml they are relative to it), or live cameras as in source_location.h; empty =
// absent.
struct CameraSources {
  std::string frames;
  std::string background;
  std::string masks;
  std::string timestamps = {};
  // A picture with the stamp t shows the scene at t + time_offset_s.
  double time_offset_s = 0.0;
  CaptureSettings capture = {};  // of a live camera

  [[nodiscard]] bool operator==(const CameraSources&) const = default;
};

// How the rig was calibrated, and how exactly.
struct RigCalibration {
  std::string made;   // when, UTC
  std::string board;  // with what
  double rms_px = 0.0;
  std::optional<double> held_out_rms_px;
  double noise_px = 0.0;  // of one coordinate of a point
  // Of all cameras' parameters in the order of recon::ParameterBlock: for each camera fx fy cx cy [px], its
  // distortion coefficients, rotation (3) [rad], translation (3) [mm], time offset [s].
  Eigen::MatrixXd covariance;
};

struct RigFile {
  core::Rig rig;
  std::vector<CameraSources> sources = {};  // one a camera
  std::optional<RigCalibration> calibration = std::nullopt;
  std::optional<core::RigGauge> gauge = std::nullopt;
  // False: lenses, places and workspace are placeholders, which the file doesn't have.
  bool is_calibrated = true;
};

// What a rig file is read for.
enum class RigUse {
  kMeasure,   // the cameras must be calibrated
  kPictures,  // they need not be: pictures are looked at, or recorded
};

// What verdicts need to know of it.
[[nodiscard]] core::RigQuality QualityOf(const RigFile& rig_file);

// Matrices may be !!opencv-matrix, a flat list, or a list of rows. Throws: Error{kFile} if it can't be read,
// Error{kFormat} for a missing or wrong key, Error{kRange} for a workspace that is empty or too large,
// Error{kCamera} for a camera that can't exist (singular matrix, no rotation, wrong number of coefficients).
// All name the file, and the camera and the key where there is one.
[[nodiscard]] RigFile ReadRigFile(const std::filesystem::path& path, RigUse use = RigUse::kMeasure);

// A camera that isn't calibrated yet: a lens of a usual angle, at a place of no meaning.
[[nodiscard]] core::CameraModel PlaceholderCamera(const std::string& name, int width_px, int height_px);

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

// Writes the whole file or nothing; every number reads back exactly. Placeholders aren't written. Sources
// below the file's folder become relative to it. Throws: Error{kFile}; PreconditionError unless `sources` has
// one entry a camera.
void WriteRigFile(const RigFile& rig_file, const std::filesystem::path& path);

// Puts the gauge into an existing rig file in place of the one that it has, and keeps all the rest as it is,
// comments included; a file whose form doesn't allow that is written anew. Throws: as ReadRigFile;
// Error{kFile}.
void SaveGauge(const core::RigGauge& gauge, const std::filesystem::path& path);

}  // namespace elbowroom::recon
