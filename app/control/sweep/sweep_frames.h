// A session's frames as a sweep takes them: with their hulls, how fast these moved, and the tools in use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/rig.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/error_budget/motion_history.h"
#include "review/spacing_study.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// The frames with a picture of each camera. Without one the hull is too large, so that a touch of it shows
// nothing.
struct SweepFrames {
  struct Frame {
    std::size_t position = 0;        // among all frames of the session
    std::vector<std::string> tools;  // in use, ascending
  };
  std::vector<Frame> frames;
  std::int64_t without_camera = 0;
};
// Throws: core::Error{kRange} if there is none.
[[nodiscard]] SweepFrames SweepFramesOf(const sessions::SessionReader& session);

// Reads the frames and makes their hulls; one whose silhouettes stay keeps its hull. The session and the
// frames must outlive it. Thread: one.
class SweepFrameLoader {
 public:
  SweepFrameLoader(const sessions::SessionReader& session, const SweepFrames& frames);

  // Where motion counts, some frames before are read, too, also such as lack a camera: as a replay does. If
  // the last one loaded was the one before, these are known. The result is the same in any order.
  [[nodiscard]] review::StudyFrame Load(std::size_t i);

 private:
  [[nodiscard]] review::StudyFrame Follow(std::size_t position);

  const sessions::SessionReader& session_;
  const SweepFrames& frames_;
  std::vector<sessions::FrameSummary> all_;
  std::vector<sessions::StampRow> stamps_;  // empty: motion doesn't count
  std::shared_ptr<const core::Rig> rig_;
  recon::UndistortedPlanes planes_;
  recon::MotionHistory motions_;
  std::shared_ptr<const recon::VisualHull> last_;
  std::size_t next_ = 0;  // position
};

}  // namespace elbowroom::control
