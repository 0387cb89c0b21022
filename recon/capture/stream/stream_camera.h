// Cameras that send a stream over the network (RTSP, HTTP), through GStreamer.
#pragma once

#include <memory>

#include "recon/capture/device/camera_device.h"

namespace elbowroom::recon {

// `request.location` is a URL that GStreamer knows. A stream has no count of its pictures: where the rate is
// known, from the request or from the stream, numbers follow the stamps, so that a gap in time is a gap in
// the numbers. Of the settings only the rate is used, as what to expect; for the others there is a warning.
// Throws: Error{kCamera} for a stream that can't be opened within kLongestOpening, that isn't decodable, or
// whose pictures have another size.
[[nodiscard]] std::unique_ptr<CameraDevice> OpenStreamCamera(const DeviceRequest& request);

inline constexpr std::chrono::seconds kLongestOpening{10};

}  // namespace elbowroom::recon
