#include "recon/footage/read_ahead.h"

#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr std::size_t kFramesAhead = 4;

}  // namespace

ReadAhead::ReadAhead(ReadFrame read) : read_(std::move(read)) {}

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
  Stop();  // not within a frame: its video would be opened again
  queue_ = std::make_unique<Queue>(kFramesAhead, core::WhenFull::kBlock);
  next_ = index;
  thread_ = std::jthread(
      [this, queue = queue_.get(), index](const std::stop_token& stop) { Run(*queue, index, stop); });
}

void ReadAhead::Run(Queue& queue, core::FrameIndex begin, const std::stop_token& stop) const {
  for (core::FrameIndex index = begin;; ++index) {
    Captured captured;
    try {
      captured.frame = read_(index, stop);
    } catch (...) {
      captured.error = std::current_exception();
    }
    const bool is_last = !captured.frame;
    if (!queue.Push(std::move(captured)) || is_last) return;
  }
}

std::optional<CameraFrame> ReadAhead::Take(const std::stop_token& stop) {
  core::Require(next_.has_value(), "a frame is expected before it is taken");
  const std::stop_callback stop_reading(stop, [this] { thread_.request_stop(); });
  std::optional<Captured> captured = queue_->Pop();
  core::Require(captured.has_value(), "a queue is open until its last frame is taken");
  if (captured->frame) {
    ++*next_;
    return std::move(captured->frame);
  }
  Stop();
  if (captured->error) std::rethrow_exception(captured->error);
  return std::nullopt;
}

std::unique_ptr<ReadAhead> ReadAheadOf(std::shared_ptr<ImageSource> source) {
  auto read = [source = std::move(source)](core::FrameIndex index, const std::stop_token& stop) {
    std::optional<CameraFrame> frame;
    if (std::optional<SourcePicture> picture = source->Read(index, stop))
      frame.emplace(CameraFrame{std::move(picture->image_bgr)});
    return frame;
  };
  return std::make_unique<ReadAhead>(std::move(read));
}

}  // namespace elbowroom::recon
