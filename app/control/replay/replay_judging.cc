#include "app/control/replay/replay_judging.h"

#include <utility>

#include "core/error.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {

ReplayJudging::ReplayJudging(const core::Layout& layout, const review::PartReviewOptions& review)
    : judges_(layout, review) {}

void ReplayJudging::Judge(const FrameResult* last, ReplayRun* run) {
  core::Require(run->goes_on == (last != nullptr), "a run that goes on is judged after the one before");
  if (last == nullptr && !part_trees().empty()) run->frames.front().result->hull->Prepare();
  std::unique_ptr<FrameJudge> judge = judges_.Take();
  for (ReplayedFrame& frame : run->frames) {
    judge->Judge(last, frame.result.get());
    last = frame.result.get();
  }
  judges_.PutBack(std::move(judge));
}

}  // namespace elbowroom::control
