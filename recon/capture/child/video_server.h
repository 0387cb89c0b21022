// What a camera program does that writes a video: it encodes the pictures of the program that started it.
#pragma once

#include <string>

#include "core/system/child_process.h"
#include "recon/capture/device/camera_device.h"

namespace elbowroom::recon {

// Serves the order `request` (recon/capture/device/video_protocol.h) for the video at `path`, until it is
// finished, can't be written, or the other end of `socket` is closed; then the process exits. It gives way to
// programs that capture and judge.
[[noreturn]] void ServeVideo(const core::Descriptor& socket, const DeviceRequest& request,
                             const std::string& path);

}  // namespace elbowroom::recon
