// Judges of the same parts for threads that judge several frames at once.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "app/control/frame_judge.h"

namespace elbowroom::control {

// Thread: any.
class FrameJudgePool {
 public:
  // The layout must outlive it and its judges. Throws: what FrameJudge throws.
  FrameJudgePool(const core::Layout& layout, const review::PartReviewOptions& review)
      : first_(layout, review) {}

  [[nodiscard]] std::span<const core::TriangleTree> part_trees() const { return first_.part_trees(); }

  // A judge that nobody else has; to be put back when it has judged.
  [[nodiscard]] std::unique_ptr<FrameJudge> Take();
  void PutBack(std::unique_ptr<FrameJudge> judge);

 private:
  FrameJudge first_;  // is never used itself
  std::mutex mutex_;  // guards the next member
  std::vector<std::unique_ptr<FrameJudge>> free_;
};

}  // namespace elbowroom::control
