// A recorded frame as it was judged.
#pragma once

#include "app/control/frame_result.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// The frame rebuilt from its recorded silhouettes and layout; contacts are those recorded. Throws:
// core::Error as SessionReader does.
[[nodiscard]] SharedFrameResult RebuildFrame(const sessions::SessionReader& session, core::FrameIndex frame);

}  // namespace elbowroom::control
