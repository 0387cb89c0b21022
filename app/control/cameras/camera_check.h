// How well a rig's live cameras do, measured for some seconds.
#pragma once

#include <cstdint>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/picture_loss.h"
#include "core/progress.h"
#include "core/spread.h"
#include "recon/capture/captured_picture.h"
#include "recon/light/light_report.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

struct CameraHealth {
  std::string name;
  recon::CameraState state;   // at the end; the report has the settings as they were read back
  std::int64_t frames = 0;    // pictures that came whole
  std::int64_t unpaired = 0;  // of those, the ones that no frame set needed
  // Pictures that the camera took, or would have taken, and that didn't come whole; by reason.
  std::map<core::LossReason, std::int64_t> losses;
  std::optional<double> rate_hz;           // from stamps and numbers; nothing: fewer than two pictures
  std::optional<core::Spread> latency_ms;  // from the middle of the exposure to the picture's arrival
  std::optional<core::Spread> skew_ms;     // |stamp - frame set's time|
  std::optional<recon::StampSource> stamps;
  double mean_level = 0.0;       // grey levels, over all channels
  double saturated_share = 0.0;  // of pixels with a channel at 255
  // Variance of the Laplacian of the grey picture, levels^2: it falls when the lens is out of focus.
  double sharpness = 0.0;
  cv::Mat picture;                          // the last one that came, as it was; empty: none
  std::optional<recon::LightReport> light;  // against the rig's background; nothing: it has none
  std::vector<std::string> advice;          // what to do about it, a line each; empty: all is well

  [[nodiscard]] std::int64_t lost() const;
};

struct RigHealth {
  std::vector<CameraHealth> cameras;
  std::int64_t sets = 0;
  std::int64_t incomplete_sets = 0;  // that lack a camera
  // From the arrival of a set's last picture to its decision, ms.
  std::optional<core::Spread> decision_ms;
  double seconds = 0.0;
  std::vector<std::string> warnings;  // of the rig as a whole

  [[nodiscard]] bool is_well() const;
};

// Throws: Error{kFormat} for a rig that isn't live.
void RequireLiveRig(const recon::RigFile& rig_file);

// Runs all cameras for so long. If the rig has backgrounds, the light is held against them. Throws: as
// recon::LiveRig; Error{kFormat} for a rig that isn't live; Error{kCancelled} on a stop.
[[nodiscard]] RigHealth CheckCameras(const recon::RigFile& rig_file, double seconds,
                                     const core::Progress& progress, const std::stop_token& stop);

// What is plugged in or answers on the network, as RIG.yml names it, with more words in brackets.
[[nodiscard]] std::vector<std::string> ListCameras(const std::stop_token& stop);

// A rig of the cameras at these locations (as ListCameras gives them, or streams), called cam1, cam2, ...,
// that aren't calibrated yet. Throws: Error{kFormat} for no camera, or for one that isn't live.
[[nodiscard]] recon::RigFile UncalibratedRig(const std::vector<std::string>& cameras, int width_px,
                                             int height_px, double rate_hz);

}  // namespace elbowroom::control
