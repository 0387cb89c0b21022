// Some pictures of each live camera, evenly spread over some seconds.
#pragma once

#include <stop_token>
#include <vector>

#include "core/progress.h"
#include "recon/light/empty_scene.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

struct CaptureSpan {
  double countdown_s = 0.0;  // before, with the cameras running; told by the progress
  double seconds = 3.0;
  int most_pictures = 60;  // a camera
};

// By camera, in order of time. `seconds` are cut into `most_pictures` equal parts, and the first picture of
// each part is kept: 0.9 MB each for 640 x 480. Throws: as recon::LiveRig; Error{kCancelled} on a stop.
[[nodiscard]] std::vector<std::vector<recon::TimedPicture>> CapturePictures(const recon::RigFile& rig_file,
                                                                            const CaptureSpan& span,
                                                                            const core::Progress& progress,
                                                                            const std::stop_token& stop);

}  // namespace elbowroom::control
