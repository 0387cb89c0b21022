// Judges the parts of a layout, frame by frame.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "app/control/frame_result.h"
#include "core/bvh.h"
#include "core/layout.h"
#include "review/part_review.h"

namespace elbowroom::control {

// Keeps what needn't be found, or allocated, again for the next frame. Thread: one frame at a time.
class FrameJudge {
 public:
  // The layout must outlive it. Throws: what Layout::Validate and PartReviewOptions::Validate throw.
  FrameJudge(const core::Layout& layout, const review::PartReviewOptions& review);

  // One of the same parts, with memory of its own: for another thread.
  [[nodiscard]] FrameJudge Another() const { return {layout_, review_, part_trees_}; }

  [[nodiscard]] std::span<const core::TriangleTree> part_trees() const { return *part_trees_; }

  // Finds contacts, recovery and clearance of each part in the result's hull, and counts what was skipped.
  // The parts stand where result->world_from_parts says. `last`: the frame before, or null; parts that didn't
  // move while the hull didn't change keep its answer. Where result->record.contacts has memory of an earlier
  // frame, the answers are put there: nothing is allocated once the memory kept is large enough
  // (judging_memory_test).
  void Judge(const FrameResult* last, FrameResult* result);

  // The same, but for the parts whose answer for this frame is known: one a part, or null. It is copied.
  using KnownAnswers = std::vector<const core::PartContact*>;
  void JudgeOthers(const KnownAnswers& known, FrameResult* result);

 private:
  using SharedTrees = std::shared_ptr<const std::vector<core::TriangleTree>>;
  FrameJudge(const core::Layout& layout, const review::PartReviewOptions& review, SharedTrees part_trees);

  [[nodiscard]] core::PartContact Review(const FrameResult& result, core::PartIndex part);

  const core::Layout& layout_;
  review::PartReviewOptions review_;
  SharedTrees part_trees_;
  std::vector<review::InsideCells> inside_parts_;
  std::vector<review::ReviewScratch> scratch_;  // one a part
  KnownAnswers known_;                          // likewise
};

}  // namespace elbowroom::control
