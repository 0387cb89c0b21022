// A session of a sweep: cut into cells, of which those that were kept aren't asked again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/sweep/spacing_sweep.h"
#include "app/control/sweep/sweep_cells.h"
#include "app/control/sweep/sweep_frames.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// What a session alone gives to a sweep.
struct SessionPiece {
  SweptSession session;
  std::vector<std::string> parts;
  std::vector<core::PartIndex> moved;
  review::StudyCount count;
  std::int64_t cells = 0;
  std::int64_t cells_from_before = 0;
};

// Thread: one.
class SessionSweep {
 public:
  // Checks all that can be wrong. Throws: as SweepSpacing.
  SessionSweep(const std::filesystem::path& session, const SpacingRange& range, const std::stop_token& stop);

  [[nodiscard]] std::int64_t frame_count() const { return std::ssize(frames_.frames); }
  [[nodiscard]] std::vector<std::string> PartNames() const;
  [[nodiscard]] std::vector<core::PartIndex> MovedParts() const;
  [[nodiscard]] std::string recording_id() const { return session_.recording_id(); }

  // `frames_done` is called with a number of frames that are through; together they are frame_count().
  // Throws: as SweepSpacing.
  [[nodiscard]] SessionPiece Run(const SweepRequest& request,
                                 const std::function<void(std::int64_t)>& frames_done,
                                 const std::stop_token& stop) const;

 private:
  [[nodiscard]] SweepCell Ask(std::size_t first, std::size_t end, SweepFrameLoader* loader,
                              const std::stop_token& stop) const;

  sessions::SessionReader session_;
  SpacingRange range_;
  review::SpacingStudyOptions options_;
  SweepFrames frames_;
};

// Of cells' curves by the tools in use. Cells and their curves come in order.
[[nodiscard]] SweptCurves CurvesOf(const std::vector<SweepCell>& cells);

// All sessions' curves together.
[[nodiscard]] SweptCurves Together(const std::vector<SweptSession>& sessions);

}  // namespace elbowroom::control
