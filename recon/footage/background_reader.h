// The background references of a rig from the files that RIG.yml names.
#pragma once

#include <stop_token>
#include <vector>

#include "core/progress.h"
#include "recon/footage/frame_set.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::recon {

// One a camera, from the frames of its background video, sequence or image (the first
// BackgroundAccumulator::kMostFrames); an empty one for a camera with ready masks. Cameras are read in
// parallel; progress counts frames of all cameras and is reported on the calling thread. Throws: Error{kFile}
// naming camera and file, Error{kFormat} for a camera without a background or with a live one;
// Error{kCancelled} on a stop.
[[nodiscard]] std::vector<BackgroundReference> ReadBackgroundReferences(const RigFile& rig_file,
                                                                        const core::Progress& progress,
                                                                        std::stop_token stop);

}  // namespace elbowroom::recon
