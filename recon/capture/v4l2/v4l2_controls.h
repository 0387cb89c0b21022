// Exposure, gain and white balance of a video device.
#pragma once

#include "recon/capture/device/camera_device.h"
#include "recon/capture/v4l2/video_system.h"

namespace elbowroom::recon {

// Sets what `wanted` gives, by hand where the device would do it by itself, and reads all of it back into the
// report. What can't be set, or is another value then, becomes a warning there.
void SetControls(const CaptureSettings& wanted, VideoSystem& system, DeviceReport* report);

}  // namespace elbowroom::recon
