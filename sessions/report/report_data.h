// What a report says, worked out from a session once: touches by part and by spacing, and the space needed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/session.h"
#include "sessions/session_reader.h"

namespace elbowroom::sessions {

// A value that a spacing had.
struct SpacingLevel {
  double spacing_mm = 0.0;
  double held_s = 0.0;  // in all
  std::int64_t frames = 0;
  std::int64_t frames_in_contact = 0;  // of one of the two parts that the spacing lies between
  std::int64_t touches = 0;            // of those, whose deepest moment was at this value
  double deepest_mm = 0.0;
};

struct SpacingStep {
  double time_s = 0.0;  // from here on
  double spacing_mm = 0.0;
};

// How one spacing went, and what that says of the space needed.
struct SpacingStudy {
  core::SpacingIndex spacing = 0;
  std::vector<SpacingStep> steps;
  std::vector<SpacingLevel> levels;  // ascending
  std::optional<double> largest_touched_mm;
  // The smallest value above every touched one that was held for kTriedFor_s without a touch.
  std::optional<double> smallest_free_mm;
};

// A spacing that was only passed on the way to another proves nothing.
inline constexpr double kTriedFor_s = 2.0;

struct PartSummary {
  PartTotals frames;
  std::int64_t touches = 0;
  double in_contact_s = 0.0;
  double deepest_mm = 0.0;
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
  std::vector<core::NearMiss> near_misses;
  std::vector<ContactRow> contacts;
  std::vector<PartSummary> parts;      // the layout's order
  std::vector<SpacingStudy> spacings;  // the layout's order
  std::optional<core::SpacingIndex>
      judged_spacing;  // that the estimate is about: the first that moved, or else the first
  double begin_s = 0.0;
  double end_s = 0.0;           // the end of the last frame
  double frame_period_s = 0.0;  // mean
  double in_contact_s = 0.0;    // any part
  std::int64_t frames_in_contact = 0;
  double deepest_mm = 0.0;
};

// Whether the part is one of the two that the spacing lies between: a touch of another says nothing of it.
[[nodiscard]] bool IsBoundedBy(const ReportData& data, core::PartIndex part, core::SpacingIndex spacing);

[[nodiscard]] ReportData CollectReportData(const SessionReader& session);

}  // namespace elbowroom::sessions
