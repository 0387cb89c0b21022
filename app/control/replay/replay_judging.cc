#include "app/control/replay/replay_judging.h"

#include <utility>

#include "core/error.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {

ReplayJudging::ReplayJudging(const core::Layout& layout, const review::PartReviewOptions& review)
    : first_(layout, review) {}

std::unique_ptr<FrameJudge> ReplayJudging::Take() {
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      std::unique_ptr<FrameJudge> judge = std::move(free_.back());
      free_.pop_back();
      return judge;
    }
  }
  return std::make_unique<FrameJudge>(first_.Another());
}

void ReplayJudging::Judge(const FrameResult* last, ReplayRun* run) {
  core::Require(run->goes_on == (last != nullptr), "a run that goes on is judged after the one before");
  if (last == nullptr && !part_trees().empty()) run->frames.front().result->hull->Prepare();
  std::unique_ptr<FrameJudge> judge = Take();
  for (ReplayedFrame& frame : run->frames) {
    judge->Judge(last, frame.result.get());
    last = frame.result.get();
  }
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(judge));
}

}  // namespace elbowroom::control
