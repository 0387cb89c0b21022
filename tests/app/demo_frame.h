// Frames of the demo as a trial judges them.
#pragma once

#include "app/control/demo_parts.h"
#include "app/control/frame_result.h"
#include "core/ids.h"
#include "recon/appearance/orbit_camera.h"

namespace elbowroom::control {

inline constexpr core::FrameIndex kFrameAtPayload = 66;  // the hand holds its pipe between the parts

// The demo's frame at this gap; that at the payload is made once. Thread: one at a time.
[[nodiscard]] SharedFrameResult DemoFrame(core::FrameIndex frame = kFrameAtPayload,
                                          double gap_mm = kGapNeededMm);

// All of the demo, 800 x 600.
[[nodiscard]] recon::SceneView DemoView();

}  // namespace elbowroom::control
