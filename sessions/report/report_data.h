// What a report says, worked out from a session once: touches by part and by spacing, and the space needed.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/session.h"
#include "sessions/report/report_touch.h"
#include "sessions/report/time_columns.h"
#include "sessions/session_reader.h"

namespace elbowroom::sessions {

// A value that a spacing had.
struct SpacingLevel {
  double spacing_mm = 0.0;
  double held_s = 0.0;  // in all
  std::int64_t frames = 0;
  std::int64_t frames_in_contact = 0;  // of a part at either end of the spacing
  std::int64_t touches = 0;            // of such parts, deepest at this value
  double deepest_mm = 0.0;
};

struct SpacingStep {
  double time_s = 0.0;  // from here on
  double spacing_mm = 0.0;
};

// How much space is needed, according to some of a trial's frames.
struct SpaceNeed {
  std::vector<SpacingLevel> levels;  // ascending
  std::optional<double> largest_touched_mm;
  // The smallest value above every touched one that was held for kTriedFor_s without a touch.
  std::optional<double> smallest_free_mm;

  [[nodiscard]] double held_s() const;
};

// The need according to the frames in which a tool was in use; the empty name: none was.
struct ToolNeed {
  std::string tool;
  SpaceNeed need;
};

// The course of one spacing over the trial, and how much space is needed according to it.
struct SpacingStudy : SpaceNeed {
  core::SpacingIndex spacing = 0;
  std::vector<SpacingStep> steps;
  std::vector<ToolNeed> by_tool;  // without a tool first; empty where none was ever marked
};

// A value that a spacing only passed on its way to another doesn't count as free of touches.
inline constexpr double kTriedFor_s = 2.0;

// The least distance between a part and the hull, over all frames.
struct ClosestApproach {
  core::FrameIndex frame = 0;
  double time_s = 0.0;
  double lower_mm = 0.0;
  double upper_mm = 0.0;
  std::vector<double> spacing_mm;
};

struct PartSummary {
  PartTotals frames;
  std::int64_t touches = 0;
  double in_contact_s = 0.0;
  double deepest_mm = 0.0;
  std::optional<ClosestApproach> closest;  // nothing: no clearance was asked, or the hull was empty
  std::vector<PartColumn> columns;
};

struct ReportData {
  std::string session_name;  // the file's
  core::SessionHeader header;
  SessionStatus status = SessionStatus::kRecording;
  bool has_outcome = false;  // touches are known, not only contacts
  std::optional<std::string> ended_at_utc;
  std::vector<FrameSummary> frames;
  std::vector<core::SessionEvent> events;
  std::vector<core::ContactEpisode> episodes;
  TouchList list;  // the worst of touches and near misses
  std::size_t near_misses = 0;
  std::vector<PartSummary> parts;      // the layout's order
  std::vector<PartBudget> budgets;     // of parts for which one was computed
  std::vector<StampRow> stamps;        // by number; none where the cameras have no stamps
  std::vector<SpacingStudy> spacings;  // the layout's order
  std::optional<core::SpacingIndex>
      judged_spacing;  // that the estimate is compared with: the first that moved, or else the first
  double begin_s = 0.0;
  double end_s = 0.0;           // the end of the last frame
  double frame_period_s = 0.0;  // mean
  double in_contact_s = 0.0;    // any part
  std::int64_t frames_in_contact = 0;
  double deepest_mm = 0.0;
  TimeColumns columns;

  [[nodiscard]] bool has_contact() const { return frames_in_contact > 0; }
  [[nodiscard]] bool has_clearance() const;
};

// Whether the part is at either end of the spacing, as a part or in a group. A touch of any other part
// doesn't show how large the spacing must be.
[[nodiscard]] bool IsBoundedBy(const core::Layout& layout, core::PartIndex part, core::SpacingIndex spacing);

// When the frame ends, s: frames need not be evenly spaced, each lasts until the next.
[[nodiscard]] double EndOf(const ReportData& data, std::size_t frame);

// The tools that events mark, in order of their first mark.
[[nodiscard]] std::vector<std::string> ToolsMarked(const ReportData& data);

// Reads every row of the session once; the visitors see those of contacts and of clearances as they
// come.
[[nodiscard]] ReportData CollectReportData(const SessionReader& session, const RowVisitor& on_contact = {},
                                           const RowVisitor& on_clearance = {});

}  // namespace elbowroom::sessions
