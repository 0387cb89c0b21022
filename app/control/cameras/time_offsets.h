// Time offsets of a rig's cameras that run freely, measured without a board.
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/progress.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

enum class OffsetMethod {
  kSilhouettes,  // of hands that move in view of all cameras; the rig has backgrounds or ready masks
  kLight,        // of a light that blinks irregularly in view of all cameras
};

struct CameraOffset {
  std::string name;
  std::int64_t pictures = 0;   // that were used
  double change_s = 0.0;       // found, against what the rig file says; 0 for the first camera
  double sigma_s = 0.0;        // standard uncertainty; 0 for the first camera
  double time_offset_s = 0.0;  // what the rig file says, and the change
};

struct TimeOffsets {
  std::vector<CameraOffset> cameras;
  double seconds = 0.0;              // of the scene
  std::optional<std::size_t> edges;  // kLight: how often the light changed
  std::optional<double> rms_px;      // kSilhouettes: of what is left
  recon::RigFile rig_file;           // with these offsets
  std::vector<std::string> warnings;
};

struct OffsetRequest {
  OffsetMethod method = OffsetMethod::kSilhouettes;
  std::optional<double> seconds;  // nothing: 30 s of live cameras, all of recorded footage
};

// recon::FindSilhouetteOffsets or recon::FindBlinkOffsets of what the rig's cameras see, live or recorded.
// Throws: what recon::OpenRig and reading throw; Error{kGeometry}, with what to do, if the pictures don't
// tell; Error{kCancelled} on a stop.
[[nodiscard]] TimeOffsets MeasureTimeOffsets(const recon::RigFile& rig_file, const OffsetRequest& request,
                                             const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::control
