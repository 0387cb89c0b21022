#include "app/control/reviewing/frame_scrubber.h"

#include <exception>
#include <utility>

#include "app/control/stopwatch.h"

namespace elbowroom::control {

FrameScrubber::FrameScrubber(std::shared_ptr<const ReviewedSession> session, OnFrame on_frame)
    : frames_(std::move(session)), on_frame_(std::move(on_frame)) {}

void FrameScrubber::Ask(std::size_t position, HeldGaps held_mm) {
  thread_.AfterThis([this, position, held_mm = std::move(held_mm)](const std::stop_token&) {
    Stopwatch watch;
    ScrubbedFrame frame{position, held_mm, nullptr, {}, 0.0};
    try {
      frame.result = frames_.At(position, held_mm);
    } catch (const std::exception& failure) {  // the thread's outermost loop: nothing may escape
      frame.error = failure.what();
    }
    frame.time_ms = watch.LapMs();
    on_frame_(frame);
  });
}

}  // namespace elbowroom::control
