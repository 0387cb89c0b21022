// From what an OpenXR headset says to a head's pose in the world.
#pragma once

#include <optional>

#include "app/control/head/head_settings.h"
#include "recon/head_pose/head_pose.h"
#include "recon/headset/headset_protocol.h"

namespace elbowroom::control {

// OpenXR's frames have x to the right, y up, z back; `tracker` has x to the right, y forward, z up, and a
// head's axes are x to the right, y down, z forward:
//   world_from_head = world_from_tracker * tracker_from_space * space_from_view * view_from_head.
// settings.signs aren't used: the standard says them. The pose's eyes come along. Nothing: the eyes' pictures
// have no size, or one that no headset has. A quaternion whose length isn't 1 makes a pose that isn't finite,
// which HeadPoseHolder refuses.
[[nodiscard]] std::optional<recon::HeadPose> HeadPoseOf(const recon::HeadsetNews& news,
                                                        const HeadSettings& settings);

}  // namespace elbowroom::control
