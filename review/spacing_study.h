// Judges recorded motion against layouts at other values of one spacing: how much space does the task need?
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/ids.h"
#include "core/layout.h"
#include "core/progress.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/part_review.h"

namespace elbowroom::review {

// The parts whose poses this spacing changes.
[[nodiscard]] std::vector<core::PartIndex> PartsMovedBy(const core::Layout& layout,
                                                        core::SpacingIndex spacing);

struct StudyFrame {
  core::FrameIndex frame = 0;
  std::shared_ptr<const recon::VisualHull> hull;
  std::vector<double> spacing_mm;  // as recorded, in the layout's order; the studied one's is not used
  std::shared_ptr<const recon::SkewErrors> skew_errors = nullptr;  // null: the cameras have no stamps
  std::size_t group = 0;                                           // below SpacingStudyOptions::groups
};

// Frames 0 ... count - 1. They are loaded one at a time; a frame may be loaded more than once.
struct StudyFrames {
  std::size_t count = 0;
  std::function<StudyFrame(std::size_t)> load;
};

struct SpacingStudyOptions {
  core::SpacingIndex spacing = 0;
  double from_mm = 0.0;  // the steps are from, from + step, ... and to
  double to_mm = 0.0;
  double step_mm = 10.0;
  double tolerance_mm = 0.5;  // between largest_touched_mm and smallest_free_mm
  std::size_t groups = 1;     // of frames: each gets a curve of its own
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
  // Bounds of the least distance over all frames: lower_mm is never above it, upper_mm never below.
  double lower_mm = std::numeric_limits<double>::infinity();
  double upper_mm = std::numeric_limits<double>::infinity();
  std::optional<core::FrameIndex> closest_frame = {};  // the frame of upper_mm; in contact, the deepest one
};

struct StudyStep {
  double spacing_mm = 0.0;
  std::vector<PartAtSpacing> parts;  // in the layout's order
};

// What the frames of a group show.
struct SpacingCurve {
  std::int64_t frames = 0;
  std::vector<StudyStep> steps;              // ascending
  std::optional<double> largest_touched_mm;  // a value at which a moved part is in the hull in some frame
  // The smallest value found at which surely no moved part is in the hull in any frame, as at all steps
  // above.
  std::optional<double> smallest_free_mm;
};

// What the frames of all these curves show together; all have the same steps and parts. closest_frame is that
// of the deepest contact, then of the least upper bound, then of the first curve. Nothing in, nothing out.
[[nodiscard]] SpacingCurve Together(std::span<const SpacingCurve> curves);

// The smallest step at which, as at all steps above, each of these parts is `clear` in every frame. Nothing:
// there is none.
[[nodiscard]] std::optional<double> SmallestClearMm(const SpacingCurve& curve,
                                                    std::span<const core::PartIndex> parts);

// Counts of questions. A question is about one part in one frame at one step.
struct StudyCount {
  std::int64_t asked = 0;  // of the hull: one ball, or contacts and, where it could matter, clearance
  std::int64_t settled_by_motion = 0;  // at another step so far away that it can't matter at this one
  std::int64_t unmoved = 0;  // the spacing doesn't move the part: the frame's one answer holds at every step
  std::int64_t queries = 0;  // of the hull
  std::int64_t unchanged_frames = 0;  // hull, spacings and group are those of the frame before

  StudyCount& operator+=(const StudyCount& other);
};

struct SpacingStudy {
  std::vector<core::PartIndex> moved;  // the parts that the spacing moves
  std::vector<SpacingCurve> curves;    // one a group
  StudyCount count;
};

// Parts of a layout that are asked.
struct StudyLayout {
  const core::Layout* layout = nullptr;  // not null
  core::SpacingIndex spacing = 0;        // the studied one, in place of SpacingStudyOptions::spacing
  std::vector<core::PartIndex> parts;    // ascending
  // This layout's spacings in a frame with these ones; nothing: they are the frame's.
  std::function<std::vector<double>(const std::vector<double>&)> spacings_from = nullptr;
};

// What the frames of a group show of one part.
struct PartCurve {
  std::int64_t frames = 0;
  std::vector<PartAtSpacing> steps;  // ascending
  // As SpacingCurve's, of this part alone. Of a part that the spacing doesn't move: nothing, and the smallest
  // step.
  std::optional<double> largest_touched_mm = {};
  std::optional<double> smallest_free_mm = {};
};

struct PartStudy {
  std::vector<PartCurve> curves;  // one a group
  StudyCount count;
};

// Of several parts of the same frames: unchanged frames, which are all parts' own, count once.
[[nodiscard]] StudyCount CountOf(std::span<const PartStudy> parts);

// What all parts of a layout show together, as StudySpacing tells it of them; `parts` are the part studies of
// one layout, in its order, and `moved` those that the spacing moves.
[[nodiscard]] SpacingStudy Joined(std::span<const PartStudy> parts, std::span<const double> steps_mm,
                                  std::vector<core::PartIndex> moved);

// One for each part of each layout, in that order. What is found of a part, and what is counted, depends on
// its mesh, its poses and the frames alone, not on which others are asked. Throws, threads: as StudySpacing.
[[nodiscard]] std::vector<PartStudy> StudyParts(std::span<const StudyLayout> layouts,
                                                const StudyFrames& frames, const SpacingStudyOptions& options,
                                                const core::Progress& progress = {},
                                                std::stop_token stop = {});

// The rules, and what is skipped, are in docs/contact_tracking.md. Verdicts and depths are those of
// ReviewPart for every frame at every step, bounds of the least distance to their tolerance
// (spacing_study_test), whatever the number of threads. Throws: core::Error as Validate, and what `frames`
// throws; Error{kCancelled}. Thread: any; `frames.load` is called on the calling thread.
[[nodiscard]] SpacingStudy StudySpacing(const core::Layout& layout, const StudyFrames& frames,
                                        const SpacingStudyOptions& options,
                                        const core::Progress& progress = {}, std::stop_token stop = {});

}  // namespace elbowroom::review
