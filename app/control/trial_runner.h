// Runs a trial from its first frame to its last, recording as it goes.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/frame_time_tally.h"
#include "app/control/layers/heat_watch.h"
#include "app/control/light/trial_light.h"
#include "app/control/pairs/pair_record.h"
#include "app/control/trial_controls.h"
#include "app/control/trial_setup.h"
#include "app/control/watch/knock_watch.h"
#include "core/error_budget.h"
#include "core/progress.h"
#include "core/session.h"
#include "sessions/session_writer.h"

namespace elbowroom::control {

// Frames first, first + 1, ... up to but not including `end`; nothing: to the end of the footage.
struct FrameRange {
  core::FrameIndex first = 0;
  std::optional<core::FrameIndex> end;
};

// How many frames the trial has seen, and how many of them neither a crash nor a power failure can take away.
struct RecordedFrames {
  std::int64_t seen = 0;
  std::int64_t committed = 0;  // on the disk
};

// How long a frame waits for the verdicts of its pairs, where frames come at the rate of their capture.
inline constexpr std::chrono::milliseconds kPairPatience{10};

struct TrialOptions {
  std::filesystem::path session;  // must not exist yet
  FrameRange frames;
  bool at_capture_rate = false;  // true: no faster than the frames were taken (console); false: full speed
  // Called for every frame on the trial's thread; must not block.
  std::function<void(const SharedFrameResult&, const RecordedFrames&)> on_frame;
  // Called on the session writer's thread when the session file can't be written, and when it can again; must
  // not block.
  std::function<void(const sessions::RecordingNews&)> on_recording;
  // Called with every frame's hull while its parts are judged, on any thread; must not block.
  std::function<void(const SharedHull&)> on_hull;
  // Live cameras only: called with each report of a camera's light, every some seconds, on a thread of its
  // own; must not block.
  OnLight on_light;
  // Called when it is new that a camera was knocked, on the trial's thread; must not block.
  std::function<void(const KnockReport&)> on_knock;
  // Gets the parts' heat maps as they grow, and all of them at the end. Null: nobody looks at them. It must
  // outlive the trial.
  HeatWatch* heat = nullptr;
  core::Progress progress;
};

struct TrialOutcome {
  std::filesystem::path session;  // the one asked for; another one if that name was taken while the trial ran
  std::int64_t frames = 0;
  std::int64_t frames_committed = 0;
  sessions::RecordingState recording = sessions::RecordingState::kInFile;  // where the last frame was written
  std::vector<std::int64_t> frames_in_contact;                             // one a part
  // One a part: the largest that a verdict allowed for; nothing where none was computed.
  std::vector<std::optional<core::ErrorBudget>> largest_budgets;
  std::vector<core::ContactEpisode> episodes;
  std::vector<core::NearMiss> near_misses;
  std::vector<PairTotal> pairs;  // one a pair of RuledPairsOf(layout)
  std::string end_note;  // why it ended: "ended with the shortest source, camera 'cam03' (426 frames)", ...
  SkipCount skipped;     // over all frames
  FrameTimeTally frame_times;  // segmentation to contacts
  // Of live cameras: from the middle of the exposure to the verdict; frames that lack a camera; pictures that
  // were lost, by camera.
  FrameTimeTally latencies;
  std::int64_t frames_without_camera = 0;
  std::vector<std::int64_t> pictures_lost;
  std::optional<recon::FootageRecording> footage;  // if the trial records it
  // Likewise: the light at the end, one a camera that has a background; and all advice that was given.
  std::vector<recon::LightReport> light;
  std::vector<std::string> light_advice;
  KnockReport knocks;  // whether a camera was knocked
};

// Measures the backgrounds, creates the session, then sends each frame through the pipeline and into the
// session; no frame is dropped. The pairs of the layout's rules are judged beside the frame in which a
// spacing changes. No frame waits for them for longer than kPairPatience, unless frames are taken as fast as
// they can be judged; that a rule is broken or kept again is noted at the frame of the change. The trial ends
// with its footage, or with a stop: the session is then complete up to that frame. It also ends when footage
// or a camera fails, and when the session file can't be written for long: all frames so far are kept, and the
// failure is thrown with their number. Only a session without a frame is removed. A request for a spacing
// that the layout doesn't have is ignored, with a note in the session. Where the setup records footage, it
// lies beside the session, in FootageFolderOf; that it can't be written is noted, and the trial goes on.
// Throws: core::Error for footage, session file, or a frame range beyond the footage; Error{kCancelled} when
// it was stopped before the first frame. Thread: the caller's; `controls` may be used from any.
TrialOutcome RunTrial(const TrialSetup& setup, const TrialOptions& options, TrialControls& controls,
                      std::stop_token stop);

// "trials/anna.footage" for "trials/anna.db".
[[nodiscard]] std::filesystem::path FootageFolderOf(const std::filesystem::path& session);

}  // namespace elbowroom::control
