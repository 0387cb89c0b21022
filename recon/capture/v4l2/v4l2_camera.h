// Webcams and other video devices of Linux (Video4Linux 2).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "recon/capture/device/camera_device.h"
#include "recon/capture/v4l2/video_system.h"

namespace elbowroom::recon {

// `request.location` is "v4l2:/dev/video0" or "device:0". Sets size, pixel format (YUYV where that has the
// rate that is asked for, else MJPEG), rate, exposure, gain and white balance, and reads them back; what
// differs is a warning in the report. Stamps and numbers are the driver's. Throws: Error{kCamera} for a
// device that can't be opened or streamed, or that has no picture of the size.
[[nodiscard]] std::unique_ptr<CameraDevice> OpenV4l2Camera(const DeviceRequest& request);

// The same with a device that is open.
[[nodiscard]] std::unique_ptr<CameraDevice> MakeV4l2Camera(const DeviceRequest& request,
                                                           std::unique_ptr<VideoSystem> system);

// "v4l2:/dev/video0 (Name)" of each device that can capture.
[[nodiscard]] std::vector<std::string> FindV4l2Cameras();

}  // namespace elbowroom::recon
