// What becomes of a replay's judged frames: the new session, and how it compares with the recorded one.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/control/outcome_tracker.h"
#include "app/control/pairs/pair_record.h"
#include "app/control/replay/finding_matches.h"
#include "app/control/replay/replay.h"
#include "app/control/replay/replay_changes.h"
#include "app/control/replay/replay_runs.h"
#include "app/control/replay/replay_segmentation.h"
#include "core/bvh.h"
#include "core/findings/finding.h"
#include "core/procedure/tools_in_use.h"
#include "core/session.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "sessions/unfinished_session.h"

namespace elbowroom::control {

// Thread: one.
class ReplayRecording {
 public:
  // `header`: of the new session, with its origin. `path`: its name, under which `file` will be put. All but
  // these two must outlive it. judges_pairs: what the recording says of pair rules doesn't hold here; they
  // are judged anew. Throws: what SessionWriter throws.
  ReplayRecording(const sessions::SessionReader& recorded, const ReplayLayout& layout,
                  std::span<const core::TriangleTree> part_trees, const core::SessionHeader& header,
                  std::filesystem::path path, sessions::UnfinishedSession* file, bool judges_pairs);

  // The next frame in order: as it was recorded, and as it was judged now.
  void Add(const ReplayedFrame& frame);

  // Completes the session and puts it in place. `to_the_end`: its last frame is the recording's. Throws:
  // core::Error{kFile} when it can't be written.
  [[nodiscard]] ReplayOutcome Finish(bool to_the_end);

  [[nodiscard]] const SegmentingCount& segmenting() const { return segmenting_; }

 private:
  void TakeEvents(core::FrameIndex frame, double time_s);
  void MarkStepUnderWay(core::FrameIndex frame, double time_s);
  void Compare(const core::FrameRecord& recorded, const core::FrameRecord& replayed);
  void TakeEvent(const core::SessionEvent& event);
  void JudgePairs(const core::FrameRecord& record);
  void TellMissing();
  [[nodiscard]] std::vector<core::FootageFile> Footage() const;

  const sessions::SessionReader& recorded_;
  const ReplayLayout& layout_;
  OutcomeTracker tracker_;
  std::vector<core::SessionEvent> events_;
  std::vector<core::SessionEvent>::const_iterator next_event_;
  std::vector<core::Finding> findings_;
  core::ToolsInUse tools_in_use_;
  bool has_earlier_ = false;
  std::optional<PairJudge> pair_judge_;  // nothing: the recording's notes are taken over
  PairRecord pair_record_;
  std::optional<std::vector<double>> judged_mm_;  // the setting that was judged last
  CheckedRange checked_;
  core::FrameIndex last_frame_ = 0;
  SegmentingCount segmenting_;
  ReplayOutcome outcome_;
  std::filesystem::path path_;
  sessions::UnfinishedSession& file_;
  sessions::SessionWriter writer_;
};

}  // namespace elbowroom::control
