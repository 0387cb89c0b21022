// A camera's reading thread: it reads the next frames while earlier ones are still being processed.
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
#include "recon/footage/image_source.h"

namespace elbowroom::recon {

// Thread: one reader; `read` runs on this object's own thread only.
class ReadAhead {
 public:
  // Nothing at and after the end. It must return at once on a stop.
  using ReadFrame = std::function<std::optional<CameraFrame>(core::FrameIndex, const std::stop_token&)>;

  explicit ReadAhead(ReadFrame read);
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  // Makes `index` the next frame to take; begins to read there unless it is that already.
  void Expect(core::FrameIndex index);

  // The frame expected, once it is read; nothing at and after the end. A stop ends the reading. Throws: what
  // reading it threw.
  [[nodiscard]] std::optional<CameraFrame> Take(const std::stop_token& stop);

 private:
  struct Captured {
    std::optional<CameraFrame> frame;
    std::exception_ptr error;  // if set, the frame could not be read
  };
  using Queue = core::BoundedQueue<Captured>;

  void Stop();
  void Run(Queue& queue, core::FrameIndex begin, const std::stop_token& stop) const;

  ReadFrame read_;
  std::optional<core::FrameIndex> next_;  // the frame that the queue yields next
  std::unique_ptr<Queue> queue_;
  std::jthread thread_;
};

// A source's pictures. Thread: the source belongs to the reading thread from then on, but for what it says
// any thread may call.
[[nodiscard]] std::unique_ptr<ReadAhead> ReadAheadOf(std::shared_ptr<ImageSource> source);

}  // namespace elbowroom::recon
