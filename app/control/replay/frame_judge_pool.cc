#include "app/control/replay/frame_judge_pool.h"

#include <utility>

namespace elbowroom::control {

std::unique_ptr<FrameJudge> FrameJudgePool::Take() {
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

void FrameJudgePool::PutBack(std::unique_ptr<FrameJudge> judge) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(judge));
}

}  // namespace elbowroom::control
