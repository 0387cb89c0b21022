// How much space recorded motion needs: one spacing of the layout swept over a range, for one session or all
// participants'.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/replay/replay_changes.h"
#include "core/ids.h"
#include "core/progress.h"
#include "review/spacing_study.h"

namespace elbowroom::control {

struct SpacingRange {
  std::string spacing;  // its name
  double from_mm = 0.0;
  double to_mm = 0.0;
  double step_mm = 10.0;
};

// Another layout, or other CAD of some parts, that the motion is judged against beside the recorded layout.
struct SweepRevision {
  std::string name;
  ReplayChanges changes;               // held_mm: empty
  std::vector<std::string> arguments;  // of --revision, with which another process gets the same
};

struct SweepRequest {
  std::vector<std::filesystem::path> sessions;  // at least one; all have parts of the same names
  SpacingRange range;
  std::filesystem::path folder;               // keeps what is done, in `cells`; made if need be
  std::vector<SweepRevision> revisions = {};  // each has the spacing that is swept
  bool keeps_hulls = false;                   // in `hulls`, for CAD to come
  // The files (CellFilesIn) whose cells count as kept from before. Nothing: all that are there.
  std::optional<std::set<std::string>> cells_before = {};
};

// The same question for all frames, and for those with a tool.
struct SweptCurves {
  review::SpacingCurve all;
  review::SpacingCurve without_tools;                     // frames in which none was marked in use
  std::map<std::string, review::SpacingCurve> with_tool;  // frames in which it was, maybe beside others
};

struct SweptSession {
  std::filesystem::path path;
  std::string recording_id;
  std::string started_at_utc;
  std::string participant;
  bool is_simulated = false;
  double estimate_mm = 0.0;                // 0: none given
  double required_clearance_mm = 0.0;      // 0: only contact was judged
  std::int64_t frames_without_camera = 0;  // left out: a picture is missing, so the hull is larger
  SweptCurves curves;
  std::vector<SweptCurves> of_revisions = {};  // in the request's order
};

// A revision against all sessions' motion.
struct SweptRevision {
  std::string name;
  std::vector<std::string> parts;
  std::vector<core::PartIndex> moved;
  std::vector<core::PartIndex>
      changed;                       // of another shape, or elsewhere, than in the recorded layout; or new
  std::vector<std::string> changes;  // in words, a line each; of the first session's layout
  SweptCurves all;
};

struct SpacingSweep {
  std::vector<std::string> parts;      // names
  std::vector<core::PartIndex> moved;  // those that the spacing moves
  std::vector<SweptSession> sessions;  // as they were asked for
  SweptCurves all;                     // of all sessions; without numbers of frames if there are several
  std::vector<SweptRevision> revisions = {};
  review::StudyCount count;     // of the recorded layout and all revisions; what they share counts once
  std::int64_t hulls = 0;       // that were made
  std::int64_t hulls_kept = 0;  // that weren't, as they were kept (SweepRequest::keeps_hulls)
  std::int64_t cells = 0;       // a part in a stretch of a session's frames at all steps
  std::int64_t cells_from_before = 0;  // of them: kept by a sweep that was ended early, or by another
};

// Judges every recorded frame at every step, against the clearance that its trial required: verdicts and
// depths are those of a replay at that value (sweep_equals_replay_test). The work is cut into cells, each a
// stretch of a session's frames at all steps. A finished cell is kept in the folder, whole or not at all, and
// isn't asked again while session, range and program stay the same. What comes out is a function of sessions
// and range alone, whatever the number of threads and whatever was kept. docs/sweep.md.
// Throws: core::Error{kRange}: no such spacing, a range beyond its limits, a session without frames, other
// parts than the first session's; {kFile}: the folder can't be written; what SessionReader throws;
// {kCancelled}: what was finished is kept. Thread: any; `progress` is called on several, one at a time.
[[nodiscard]] SpacingSweep SweepSpacing(const SweepRequest& request, const core::Progress& progress,
                                        const std::stop_token& stop);

// What SweepSpacing would throw at once for these sessions. Nothing is judged or written.
void CheckSweep(const SweepRequest& request, const std::stop_token& stop);

}  // namespace elbowroom::control
