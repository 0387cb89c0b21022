#include "app/control/frame_result_pool.h"

#include <mutex>
#include <utility>
#include <vector>

namespace elbowroom::control {
namespace {

// More are let go: a trial holds the last frame's, this one's, and those that a window hasn't shown yet.
constexpr std::size_t kMostKept = 4;

void Empty(FrameResult* result) {
  std::vector<core::PartContact> contacts = std::move(result->record.contacts);
  *result = {};
  result->record.contacts = std::move(contacts);
}

}  // namespace

class FrameResultPool::Shelf {
 public:
  Shelf() { kept_.reserve(kMostKept); }

  std::unique_ptr<FrameResult> Take() {
    const std::lock_guard lock(mutex_);
    if (kept_.empty()) return std::make_unique<FrameResult>();
    std::unique_ptr<FrameResult> result = std::move(kept_.back());
    kept_.pop_back();
    return result;
  }

  void Return(std::unique_ptr<FrameResult> result) {
    Empty(result.get());
    const std::lock_guard lock(mutex_);
    if (kept_.size() < kMostKept) kept_.push_back(std::move(result));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<FrameResult>> kept_;
};

FrameResultPool::FrameResultPool() : shelf_(std::make_shared<Shelf>()) {}

std::shared_ptr<FrameResult> FrameResultPool::Take() {
  return {shelf_->Take().release(),
          [shelf = shelf_](FrameResult* result) { shelf->Return(std::unique_ptr<FrameResult>(result)); }};
}

}  // namespace elbowroom::control
