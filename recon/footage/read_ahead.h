// A camera's capture thread: it reads the next frames while earlier ones are still being processed.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

#include "core/bounded_queue.h"
#include "core/ids.h"
#include "recon/footage/frame_set.h"

namespace elbowroom::recon {

struct CapturedFrame {
  CameraFrame frame;
  std::exception_ptr error;  // if set, `frame` could not be read
};

// Thread: one reader; `read` runs on this object's own thread only.
class ReadAhead {
 public:
  // It must end at once on a stop, since a camera may have no next picture.
  using ReadFrame = std::function<CameraFrame(core::FrameIndex, const std::stop_token&)>;

  // Recorded frames (with `end`) wait until they are taken; of a live camera's frames only the latest are
  // kept.
  ReadAhead(ReadFrame read, std::optional<core::FrameIndex> end);
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  // Makes `index` (below the end) the next frame to take; begins to read there unless it is that already.
  void Expect(core::FrameIndex index);

  // The frame expected, once it is read; a stop ends the reading. Throws: what reading it threw.
  [[nodiscard]] CapturedFrame Take(const std::stop_token& stop);

 private:
  using Queue = core::BoundedQueue<CapturedFrame>;

  void Stop();
  void Run(Queue& queue, core::FrameIndex begin, const std::stop_token& stop) const;

  ReadFrame read_;
  std::optional<core::FrameIndex> end_;
  std::optional<core::FrameIndex> next_;  // the frame that the queue yields next
  std::unique_ptr<Queue> queue_;
  std::jthread thread_;
};

}  // namespace elbowroom::recon
