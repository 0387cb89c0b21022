// GigE Vision and USB3 Vision cameras, through Aravis.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "recon/capture/device/camera_device.h"

namespace elbowroom::recon {

// `request.location` is "gige:NAME", where NAME is a name that FindGenicamCameras gives, or an address. Sets
// the camera, reads the settings back and starts it; what the camera can't do is a warning in its report.
// Throws: Error{kCamera} for a camera that doesn't answer, that another program holds, or that can't give
// pictures of the size or of a known pixel format.
[[nodiscard]] std::unique_ptr<CameraDevice> OpenGenicamCamera(const DeviceRequest& request);

// The names of all that answer on the network and on USB, within about a second.
[[nodiscard]] std::vector<std::string> FindGenicamCameras();

}  // namespace elbowroom::recon
