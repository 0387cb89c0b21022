// A session judged again: as it was, or against other spacings, another layout, or other revisions of parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/replay/replay_changes.h"
#include "app/control/replay/replay_segmentation.h"
#include "app/control/trial_runner.h"
#include "core/progress.h"
#include "core/session.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

struct ReplayOptions {
  std::filesystem::path session;  // the new one; must not exist yet
  ReplayChanges changes;
  FrameRange frames;                                           // by the numbers of the recorded frames
  std::optional<SegmentingOptions> segmenting = std::nullopt;  // nothing: the recorded silhouettes are judged
};

// Silhouettes that were segmented again.
struct ReplaySegmented {
  std::filesystem::path footage;  // the RIG.yml that names the pictures
  SegmentingCount count;
  std::vector<std::string> warnings;
};

// How the replay's rows compare with the recorded ones.
struct ReplayComparison {
  std::int64_t frames = 0;
  std::int64_t rows = 0;  // of part_frame, contact, contact_point, clearance, part_motion
  std::int64_t frames_that_differ = 0;
  std::optional<core::FrameIndex> first_that_differs;
};

struct ReplayOutcome {
  std::int64_t frames = 0;
  std::int64_t contact_rows = 0;             // parts in contact, frame by frame
  core::SessionOutcome outcome;              // with the ids of findings
  std::vector<core::Finding> absent;         // findings of the origin that aren't here
  std::vector<std::string> changes;          // in words; empty: nothing was changed
  std::optional<ReplayComparison> compared;  // nothing: something was changed
  std::optional<ReplaySegmented> segmented;
  SkipCount skipped;
  double time_s = 0.0;  // from the first frame read to the last one written
};

// Sends the recorded silhouettes through the code of a trial, and records a new session that says what it is
// a replay of. Silhouettes that stay keep their hull; frames are judged several at once where no part gives
// way and the silhouettes are those recorded. Nothing is segmented, unless that is asked for: then the
// silhouettes are made anew of the footage's pictures, and their changes are among the changes. Without
// changes all rows are the recorded ones, bit for bit, on the machine and with the program that recorded them
// (replay_test); across processors and compilers docs/replay.md states the tolerance. Findings keep their ids
// and reviews (MatchFindings). The new file appears whole, or not at all. Throws: core::Error{kFile}: the new
// session exists, or can't be written; {kRange}: no such frames, spacing or part, a value beyond its limits;
// what SessionReader and ReplaySegmentation throw; {kCancelled}.
ReplayOutcome RunReplay(const sessions::SessionReader& recorded, const ReplayOptions& options,
                        const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::control
