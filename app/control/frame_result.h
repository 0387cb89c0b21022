// What one frame yielded: what is recorded of it, and what only the running program has of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/control/pairs/pair_judge.h"
#include "app/control/part_reactions.h"
#include "core/contact.h"
#include "core/ids.h"
#include "core/layout.h"
#include "core/procedure/step_runs.h"
#include "core/session.h"
#include "recon/error_budget/skew_errors.h"
#include "recon/footage/frame_set.h"
#include "recon/hull/hull_stats.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/segmentation/segmentation.h"

namespace elbowroom::control {

// What a frame did not need to compute, and why.
struct SkipCount {
  recon::SegmentationStats segmentation;
  recon::HullStats hull;
  int unchanged_parts = 0;             // hull and pose are the last frame's, and so is the answer
  std::int64_t triangles_in_all = 0;   // those of the parts that were asked
  std::int64_t triangles_skipped = 0;  // how many of them were settled with a whole branch of the part's tree
  std::int64_t queries = 0;            // ball queries for contacts
  int clearances_by_contact = 0;       // parts in contact: their clearance is 0 without a search
  int clearances_by_ball = 0;          // parts that one ball query showed to be far enough away
  std::int64_t clearance_queries = 0;  // queries of the hull for clearances
  review::ClashCount pairs;            // of the layout's rules

  // Adds the counts of another frame.
  SkipCount& operator+=(const SkipCount& other);
};

struct StageTimes {
  double segmentation_ms = 0.0;
  double hull_ms = 0.0;
  double contacts_ms = 0.0;
  double response_ms = 0.0;
};

using SharedHull = std::shared_ptr<const recon::VisualHull>;

// The session keeps the record; the rest can be worked out again from it and from the session's header, but
// for the pictures, the counts and the times.
struct FrameResult {
  core::FrameRecord record;
  // The pictures that the masks come from. Null for a frame that was read from a session.
  std::shared_ptr<const recon::FrameSet> camera_frames;
  SharedHull hull;
  // Null: the cameras have no stamps, or no clearance is required, or the frame was read from a session.
  std::shared_ptr<const recon::SkewErrors> skew_errors;
  std::shared_ptr<const core::Layout> layout;
  std::vector<core::RigidTransform> world_from_parts;  // in the layout's order, where parts are
  SharedReactions response;                            // to this frame; null: nothing gives way or flows
  // Of the layout's pair rules, in a running trial. Its setting may be an earlier one: this frame's is being
  // judged then. Null: the layout has no pair rules, or none was judged yet, or the frame was read from a
  // session.
  SharedPairVerdicts pairs;
  // Of the procedure, in a running trial. Nothing: none is under way.
  std::optional<core::StepRun> step;
  SkipCount skipped;
  StageTimes times;
};

using SharedFrameResult = std::shared_ptr<const FrameResult>;

}  // namespace elbowroom::control
