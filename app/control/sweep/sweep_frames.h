// A session's frames as a sweep takes them: with their hulls, how fast these moved, and the tools in use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/control/replay/recorded_motion.h"
#include "review/spacing_study.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// The frames with a picture of each camera. Without one the hull is too large, so that a touch of it shows
// nothing.
struct SweepFrames {
  struct Frame {
    std::size_t position = 0;        // among all frames of the session
    std::vector<std::string> tools;  // in use, ascending
    std::vector<double> spacing_mm;  // as recorded, in the layout's order
  };
  std::vector<Frame> frames;
  std::int64_t without_camera = 0;
  bool is_simulated = false;  // the session
};
// Throws: core::Error{kRange} if there is none.
[[nodiscard]] SweepFrames SweepFramesOf(const sessions::SessionReader& session);

// Reads the frames as a replay does, also such as lack a camera where motion counts. The session and the
// frames must outlive it. Thread: one.
class SweepFrameLoader {
 public:
  SweepFrameLoader(const sessions::SessionReader& session, const SweepFrames& frames,
                   RecordedMotion::HullKeeper keeper = {});

  // The result is the same in any order.
  [[nodiscard]] review::StudyFrame Load(std::size_t i);
  // So far; those of frames whose silhouettes are the frame's before count once.
  [[nodiscard]] std::int64_t hulls_made() const { return motion_.hulls_made(); }
  [[nodiscard]] std::int64_t hulls_kept() const { return motion_.hulls_kept(); }

 private:
  const SweepFrames& frames_;
  RecordedMotion motion_;
};

}  // namespace elbowroom::control
