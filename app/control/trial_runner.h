// Runs a trial from its first frame to its last, recording as it goes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/trial_controls.h"
#include "app/control/trial_setup.h"
#include "core/progress.h"
#include "core/session.h"
#include "sessions/session_writer.h"

namespace elbowroom::control {

// Frames first, first + 1, ... up to but not including `end`; nothing: to the end of the footage.
struct FrameRange {
  core::FrameIndex first = 0;
  std::optional<core::FrameIndex> end;
};

// What a crash or a power failure would leave of the frames seen so far.
struct RecordedFrames {
  std::int64_t seen = 0;
  std::int64_t committed = 0;  // on the disk
};

struct TrialOptions {
  std::filesystem::path session;  // must not exist yet
  FrameRange frames;
  bool at_capture_rate = false;  // true: no faster than the frames were taken (console); false: flat out
  // Called for every frame on the trial's thread; must not block.
  std::function<void(const SharedFrameResult&, const RecordedFrames&)> on_frame;
  // Called on the session writer's thread when the session file can't be written, and when it can again; must
  // not block.
  std::function<void(const sessions::RecordingNews&)> on_recording;
  // Called with every frame's hull while its parts are judged, on any thread; must not block.
  std::function<void(const SharedHull&)> on_hull;
  core::Progress progress;
};

struct TrialOutcome {
  std::filesystem::path session;  // as asked; another name where that was taken while the trial ran
  std::int64_t frames = 0;
  std::int64_t frames_committed = 0;
  sessions::RecordingState recording = sessions::RecordingState::kInFile;  // where the last frame went
  std::vector<std::int64_t> frames_in_contact;                             // one a part
  std::vector<core::ContactEpisode> episodes;
  std::vector<core::NearMiss> near_misses;
  std::string end_note;  // why it ended: "ended with the shortest source, camera 'cam03' (426 frames)", ...
  SkipCount skipped;     // over all frames
  std::vector<double> frame_ms;  // segmentation to contacts, frame by frame
};

// Backgrounds are measured, the session is created, then each frame goes through the pipeline to the session,
// whose writer never drops one. A stop ends the trial in order: the session is complete up to there. So does
// footage or a camera that fails, and a session file that can't be written for long; then the failure is
// thrown, with the number of frames that are kept. Only a session without a frame is removed. Throws:
// core::Error: footage, session file, frame range beyond the footage; Error{kCancelled} when it was stopped
// before the first frame. An unknown spacing in a wish is ignored with a note in the session. Thread: the
// caller's; `controls` from any.
TrialOutcome RunTrial(const TrialSetup& setup, const TrialOptions& options, TrialControls& controls,
                      std::stop_token stop);

}  // namespace elbowroom::control
