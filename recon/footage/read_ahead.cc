#include "recon/footage/read_ahead.h"

#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr std::size_t kFramesAhead = 4;
// The latest, and one more, so that the end of a stream does not push out its last picture.
constexpr std::size_t kLiveFrames = 2;

}  // namespace

ReadAhead::ReadAhead(ReadFrame read, std::optional<core::FrameIndex> end)
    : read_(std::move(read)), end_(end) {}

ReadAhead::~ReadAhead() {
  thread_.request_stop();
  Stop();
}

void ReadAhead::Stop() {
  if (queue_) queue_->Close();  // a thread that waits for room gives up
  if (thread_.joinable()) thread_.join();
  next_.reset();
}

void ReadAhead::Expect(core::FrameIndex index) {
  if (next_ == index) return;
  if (!end_) thread_.request_stop();  // not within a recorded frame: its video would be opened again
  Stop();
  queue_ = end_ ? std::make_unique<Queue>(kFramesAhead, core::WhenFull::kBlock)
                : std::make_unique<Queue>(kLiveFrames, core::WhenFull::kDropOldest);
  next_ = index;
  thread_ = std::jthread(
      [this, queue = queue_.get(), index](const std::stop_token& stop) { Run(*queue, index, stop); });
}

void ReadAhead::Run(Queue& queue, core::FrameIndex begin, const std::stop_token& stop) const {
  for (core::FrameIndex index = begin; !end_ || index < *end_; ++index) {
    CapturedFrame captured;
    try {
      captured.frame = read_(index, stop);
    } catch (...) {
      captured.error = std::current_exception();
    }
    const bool is_last = captured.error != nullptr;
    if (!queue.Push(std::move(captured)) || is_last) return;
  }
}

CapturedFrame ReadAhead::Take(const std::stop_token& stop) {
  core::Require(next_.has_value(), "a frame is expected before it is taken");
  const std::stop_callback stop_reading(stop, [this] { thread_.request_stop(); });
  std::optional<CapturedFrame> captured = queue_->Pop();
  core::Require(captured.has_value(), "a frame that is taken lies below the end");
  if (captured->error) {
    Stop();
    std::rethrow_exception(captured->error);
  }
  ++*next_;
  return std::move(*captured);
}

}  // namespace elbowroom::recon
