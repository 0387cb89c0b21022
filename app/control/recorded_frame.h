// A recorded frame as it was judged.
#pragma once

#include <filesystem>
#include <memory>

#include "app/control/frame_result.h"
#include "core/layout.h"
#include "core/rig.h"
#include "core/session.h"
#include "recon/contours/undistorted_plane.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// The frame rebuilt from its recorded silhouettes and layout; contacts are those recorded. Throws:
// core::Error as SessionReader does.
[[nodiscard]] SharedFrameResult RebuildFrame(const sessions::SessionReader& session, core::FrameIndex frame);

// The same for many frames of one session: what the frames share is worked out once. Thread: one at a time.
class FrameRebuilder {
 public:
  // `session`: its name, for messages.
  FrameRebuilder(const core::SessionHeader& header, std::filesystem::path session);

  // `last`: the hull of any frame of the session, whose unchanged silhouettes are kept; or null. Throws:
  // core::Error{kFormat}: a part is nowhere near a trial.
  [[nodiscard]] SharedFrameResult Rebuild(core::FrameRecord record, const SharedHull& last = nullptr);

  [[nodiscard]] const core::SpacingPoses& poses() const { return poses_; }  // of the session's layout

 private:
  std::filesystem::path session_;
  std::shared_ptr<const core::Rig> rig_;
  std::shared_ptr<const core::Layout> layout_;
  core::SpacingPoses poses_;
  recon::UndistortedPlanes planes_;  // none before the first frame
};

}  // namespace elbowroom::control
