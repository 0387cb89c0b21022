// Recorded motion against a layout at other values of one spacing: how much space does the task need?
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/ids.h"
#include "core/layout.h"
#include "core/progress.h"
#include "recon/hull/visual_hull.h"
#include "review/part_review.h"

namespace elbowroom::review {

struct StudyFrame {
  core::FrameIndex frame = 0;
  std::shared_ptr<const recon::VisualHull> hull;
  std::vector<double> spacing_mm;  // as recorded, in the layout's order; the studied one's is not used
};

// Frames 0 ... count - 1, loaded one at a time, each possibly more than once.
struct StudyFrames {
  std::size_t count = 0;
  std::function<StudyFrame(std::size_t)> load;
};

struct SpacingStudyOptions {
  core::SpacingIndex spacing = 0;
  double from_mm = 0.0;  // from, from + step, ... and to
  double to_mm = 0.0;
  double step_mm = 10.0;
  double tolerance_mm = 0.5;  // between largest_touched_mm and smallest_free_mm
  PartReviewOptions review;

  // Throws: core::Error{kRange}: values that are no range, beyond the spacing's limits, or too many steps.
  void Validate(const core::Layout& layout) const;
  [[nodiscard]] std::vector<double> Steps() const;  // ascending
};

// A part at one value of the spacing, over all frames.
struct PartAtSpacing {
  std::int64_t frames_in_contact = 0;
  std::int64_t frames_near = 0;
  std::int64_t frames_undecided = 0;
  std::int64_t frames_clear = 0;
  double deepest_mm = 0.0;  // certified lower bound
  // Bounds of the least distance over all frames: the one is never above it, the other never below.
  double lower_mm = std::numeric_limits<double>::infinity();
  double upper_mm = std::numeric_limits<double>::infinity();
  std::optional<core::FrameIndex> closest_frame;  // that upper_mm is of; in contact, the deepest
};

struct StudyStep {
  double spacing_mm = 0.0;
  std::vector<PartAtSpacing> parts;  // in the layout's order
};

// Counts of questions: one is about a part in a frame at a step.
struct StudyCount {
  std::int64_t asked = 0;              // contacts, and clearance where it was of interest
  std::int64_t settled_by_motion = 0;  // too far at another step to matter at this one
  std::int64_t unmoved = 0;            // by the spacing: the frame's one answer holds at every step
  std::int64_t queries = 0;            // of the hull
};

struct SpacingStudy {
  std::vector<StudyStep> steps;              // ascending
  std::vector<core::PartIndex> moved;        // by the spacing
  std::optional<double> largest_touched_mm;  // a moved part is in the hull here, in some frame
  // The smallest found at which every frame is sure to be free of every moved part, as at all steps above.
  std::optional<double> smallest_free_mm;
  StudyCount count;
};

// Rules and what is skipped: docs/contact_tracking.md. The answers are those of asking every frame at every
// step, clearances to their tolerance (spacing_study_test), whatever the number of threads.
// Throws: core::Error as Validate, and what `frames` throws; Error{kCancelled}. Thread: the caller's loads.
[[nodiscard]] SpacingStudy StudySpacing(const core::Layout& layout, const StudyFrames& frames,
                                        const SpacingStudyOptions& options,
                                        const core::Progress& progress = {}, std::stop_token stop = {});

}  // namespace elbowroom::review
