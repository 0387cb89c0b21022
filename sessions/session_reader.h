// Reads a session back: for reports, for replay, also while it is still being recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/findings/finding.h"
#include "core/session.h"
#include "sessions/recorded_contacts.h"
#include "sessions/stamp_rows.h"

namespace elbowroom::sessions {

enum class SessionStatus {
  kRecording,  // under way when it was opened: frames and events, no episodes
  kCutOff,     // its program ended without finishing it: likewise
  kComplete,
  kAbandoned,  // its writer is removing it
};

[[nodiscard]] std::string_view ToString(SessionStatus status);

// A frame without its silhouettes and contacts.
struct FrameSummary {
  core::FrameIndex frame = 0;
  double time_s = 0.0;
  std::vector<double> spacing_mm;  // in the layout's order
};

// Only reads, except that opening puts right what a crash left (OpenSession). A file of an older schema is
// migrated in memory. Each call sees what is committed by then. Every call throws Error{kDatabase} or
// Error{kFormat} naming the file where it is damaged: the numbers that it returns are finite, indices are
// within the header's lists, and masks and meshes match their checksums. A text is valid UTF-8. Thread: one
// at a time.
class SessionReader {
 public:
  // Checks the whole file first (docs/session_database.md, "Damaged files").
  // Throws: Error{kFile} when there is no such file, Error{kFormat} when it is no session, one of a newer
  // schema or a damaged one, Error{kDatabase} when it can't be read; here and in every call Error{kCancelled}
  // when a stop is requested in the middle of a long query.
  explicit SessionReader(const std::filesystem::path& path, const std::stop_token& stop = {});
  ~SessionReader();
  SessionReader(SessionReader&&) noexcept;
  SessionReader& operator=(SessionReader&&) noexcept;

  [[nodiscard]] const std::filesystem::path& path() const;
  [[nodiscard]] const core::SessionHeader& header() const;
  [[nodiscard]] SessionStatus status() const;
  [[nodiscard]] std::int64_t file_schema() const;  // of the file, before it was migrated in memory
  [[nodiscard]] std::optional<std::string> ended_at_utc() const;  // nothing while recording

  [[nodiscard]] std::int64_t frame_count() const;
  [[nodiscard]] std::vector<FrameSummary> frames()
      const;  // by number; times never decrease; numbers may start above 0 and have gaps

  // With bit-equal silhouettes and every contact. Throws: Error{kRange} for a frame that wasn't recorded.
  [[nodiscard]] core::FrameRecord ReadFrame(core::FrameIndex frame) const;

  // From here on every call sees the session as it is now, whatever is recorded meanwhile.
  void Freeze();

  // Whether the session has its outcome: it is complete, or AdoptOutcome() was called.
  [[nodiscard]] bool has_outcome() const;
  // From here on episodes, near misses and heat maps are these; the file stays as it is.
  void AdoptOutcome(core::SessionOutcome outcome);

  [[nodiscard]] std::vector<core::SessionEvent> events() const;      // by frame, then as they came
  [[nodiscard]] std::vector<core::ContactEpisode> episodes() const;  // by id; none without an outcome
  [[nodiscard]] std::vector<core::NearMiss> near_misses() const;     // likewise
  [[nodiscard]] std::vector<core::HeatMap> heat_maps() const;        // by part; likewise
  // Touches and near misses as reviewers follow them, by time; each episode and near miss that there is, too.
  [[nodiscard]] std::vector<core::Finding> findings() const;
  [[nodiscard]] std::vector<core::FootageFile> footage() const;  // RIG.yml first; none: not kept
  [[nodiscard]] std::string first_recording_id() const;      // of the session that cameras or footage gave
  [[nodiscard]] std::string recording_id() const;            // of this one
  [[nodiscard]] std::vector<ContactRow> contacts() const;    // every part in contact, frame by frame
  [[nodiscard]] std::vector<ContactRow> clearances() const;  // every part with a clearance, likewise
  // The same rows one by one, for sessions of any length, in one pass: a row may be of both kinds. An empty
  // visitor wants none. Visitors must not read the session.
  void VisitRows(const RowVisitor& on_contact, const RowVisitor& on_clearance) const;
  [[nodiscard]] std::vector<PartTotals> part_totals() const;   // one a part
  [[nodiscard]] std::vector<PartBudget> part_budgets() const;  // of parts for which one was computed
  [[nodiscard]] std::vector<StampRow> stamp_rows() const;      // those with stamps, by number

  // The steps of SQLite's virtual machine that the most expensive query so far took (QueryLimit).
  [[nodiscard]] std::int64_t most_steps_taken() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::sessions
