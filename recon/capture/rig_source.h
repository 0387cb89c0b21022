// A rig's frame sets, whether its cameras are live or recorded.
#pragma once

#include <memory>
#include <stop_token>

#include "recon/capture/live_rig.h"
#include "recon/footage/frame_set.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::recon {

// A LiveRig with those taps if all cameras are live, else a RecordedRig. Throws: what their constructors
// throw; Error{kFormat} naming two cameras for a rig of which one is live and the other one is not.
[[nodiscard]] std::shared_ptr<FrameSetSource> OpenRig(RigFile rig_file, const std::stop_token& stop,
                                                      LiveTaps taps = {});

// Whether all cameras of the rig are live. Throws: Error{kFormat} as OpenRig.
[[nodiscard]] bool IsLiveRig(const RigFile& rig_file);

}  // namespace elbowroom::recon
