// A session of a sweep: cut into cells, of which those that were kept aren't asked again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/replay/replay_changes.h"
#include "app/control/sweep/spacing_sweep.h"
#include "app/control/sweep/sweep_cells.h"
#include "app/control/sweep/sweep_frames.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// The parts of a layout.
struct SweptParts {
  std::vector<std::string> names;
  std::vector<core::PartIndex> moved;    // by the spacing
  std::vector<core::PartIndex> changed;  // as SweptRevision's
  [[nodiscard]] bool operator==(const SweptParts&) const = default;
};

// What a session alone gives to a sweep.
struct SessionPiece {
  SweptSession session;
  review::StudyCount count;
  std::int64_t hulls = 0, hulls_kept = 0;
  std::int64_t cells = 0;
  std::int64_t cells_from_before = 0;
};

// Thread: one.
class SessionSweep {
 public:
  // Checks all that can be wrong. Throws: as SweepSpacing.
  // `request` must outlive it.
  SessionSweep(const std::filesystem::path& session, const SweepRequest& request,
               const std::stop_token& stop);

  [[nodiscard]] std::int64_t frame_count() const { return std::ssize(frames_.frames); }
  // Of the recorded layout, then of each revision.
  [[nodiscard]] std::vector<SweptParts> Parts() const;
  [[nodiscard]] std::string recording_id() const { return session_.recording_id(); }
  // What each revision changes, in words.
  [[nodiscard]] std::vector<std::vector<std::string>> ChangesOfRevisions() const;

  // `frames_done` is called with a number of frames that are through; together they are frame_count().
  // Throws: as SweepSpacing.
  [[nodiscard]] SessionPiece Run(const std::function<void(std::int64_t)>& frames_done,
                                 const std::stop_token& stop) const;

 private:
  // A layout that the motion is judged against.
  struct Judged {
    ReplayLayout replayed;
    core::Layout layout;  // with limits of the spacing that are no narrower than the recorded ones
    core::SpacingIndex spacing = 0;
    SweptParts parts;
  };
  using Keys = std::vector<std::vector<CellKey>>;            // of each layout's parts
  using MeshHashes = std::vector<std::vector<std::string>>;  // likewise

  [[nodiscard]] Judged JudgedWith(const ReplayChanges& changes) const;
  // The same; what can't be judged is said of the session, and of the revision if it has a name.
  [[nodiscard]] Judged JudgedAs(const std::string& revision, const ReplayChanges& changes) const;
  // The parts that have another shape than in the recorded layout, or another place at an end of the range.
  [[nodiscard]] std::vector<core::PartIndex> ChangedIn(const Judged& judged) const;
  [[nodiscard]] MeshHashes HashMeshes() const;
  [[nodiscard]] Keys KeysOf(std::size_t first, std::size_t end, const MeshHashes& hashes,
                            const SweepCells& cells) const;
  [[nodiscard]] SweepCellsByKey Ask(std::size_t first, std::size_t end, const Keys& keys,
                                    const std::set<CellKey>& missing, SweepFrameLoader* loader,
                                    const std::stop_token& stop) const;

  const SweepRequest& request_;
  sessions::SessionReader session_;
  review::SpacingStudyOptions options_;
  SweepFrames frames_;
  std::vector<Judged> judged_;  // the recorded layout, then the revisions
};

// What a stretch of frames shows of a layout, by the tools in use.
struct StretchCurves {
  std::vector<std::vector<std::string>> tools;
  std::vector<review::SpacingCurve> curves;
};

// Stretches and their curves come in order.
[[nodiscard]] SweptCurves CurvesOf(const std::vector<StretchCurves>& stretches);

// Several sessions' curves together.
[[nodiscard]] SweptCurves Together(const std::vector<SweptCurves>& sessions);

}  // namespace elbowroom::control
