// A session under review: what is in it, any frame of it, and what reviewers say of its touches.
#pragma once

#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/findings/finding.h"
#include "core/progress.h"
#include "core/session.h"
#include "sessions/bcf/review_import.h"
#include "sessions/review_editor.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// The session as it was when it was opened, but for the reviewers' remarks. The file is open once, for all
// threads, and closed while remarks are added to it. Thread: any.
class ReviewedSession {
 public:
  // A session that was cut off gets the outcome of its frames, as a report does. Throws: what OpenWithOutcome
  // throws; core::Error{kRange}: it has no frames.
  ReviewedSession(const std::filesystem::path& path, const core::Progress& progress,
                  const std::stop_token& stop);
  ~ReviewedSession();
  ReviewedSession(const ReviewedSession&) = delete;
  ReviewedSession& operator=(const ReviewedSession&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const core::SessionHeader& header() const { return header_; }
  [[nodiscard]] sessions::SessionStatus status() const { return status_; }
  [[nodiscard]] const std::vector<sessions::FrameSummary>& frames() const { return frames_; }  // at least one
  [[nodiscard]] const std::vector<core::SessionEvent>& events() const { return events_; }
  [[nodiscard]] const core::SessionOutcome& outcome() const { return outcome_; }  // without heat maps
  [[nodiscard]] const std::vector<core::HeatMap>& heat_maps() const { return heat_maps_; }  // of all frames
  [[nodiscard]] const std::vector<sessions::PartTotals>& part_totals() const { return part_totals_; }
  // Of the frames, where the verdicts on clearance count the cameras' motion; else none.
  [[nodiscard]] const std::vector<sessions::StampRow>& motion_stamps() const { return motion_stamps_; }
  // Ascending.
  [[nodiscard]] const std::vector<std::size_t>& PositionsWithAllCameras() const { return complete_; }

  // The position of the last frame at or before that time; 0 before the first one.
  [[nodiscard]] std::size_t PositionAt(double time_s) const;
  // The position of that frame; where it wasn't recorded, of the next one that was, or of the last.
  [[nodiscard]] std::size_t PositionOf(core::FrameIndex frame) const;

  // Throws: what SessionReader throws; core::Error{kFile}: the file is gone.
  [[nodiscard]] core::FrameRecord ReadFrame(core::FrameIndex frame) const;

  [[nodiscard]] std::vector<core::Finding> findings() const;  // by time, each with its remarks
  // Adds the remarks to the file, as `elbowroom touches SESSION set` does: all or none. Throws: what
  // AddRemarks and RequireFit throw.
  void Say(std::span<const sessions::FindingRemark> remarks);
  // Takes over what a BCF file says, as `elbowroom touches SESSION import`. Throws: what ReadReview and
  // AddRemarks throw.
  sessions::ReviewImport Import(const std::filesystem::path& bcf_file);

 private:
  // Both with mutex_ held.
  [[nodiscard]] const sessions::SessionReader& Reader() const;
  void Add(std::span<const sessions::FindingRemark> remarks);

  std::stop_source stop_;  // of queries
  std::filesystem::path path_;
  core::SessionHeader header_;
  sessions::SessionStatus status_ = sessions::SessionStatus::kComplete;
  std::vector<sessions::FrameSummary> frames_;
  std::vector<core::SessionEvent> events_;
  core::SessionOutcome outcome_;
  std::vector<core::HeatMap> heat_maps_;
  std::vector<sessions::PartTotals> part_totals_;
  std::vector<sessions::StampRow> motion_stamps_;
  std::vector<std::size_t> complete_;
  mutable std::mutex mutex_;                               // guards the following
  mutable std::optional<sessions::SessionReader> reader_;  // nothing: it is opened when it is needed
  std::vector<core::Finding> findings_;
};

}  // namespace elbowroom::control
