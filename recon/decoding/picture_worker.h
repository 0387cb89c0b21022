// A child process that reads one source's pictures, so that no file and no camera can take this program down.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/system/child_process.h"
#include "core/system/shared_memory.h"
#include "recon/decoding/picture_protocol.h"

namespace elbowroom::recon {

enum class SourceMemory { kPicture, kVideo };

struct WorkerNeeds {
  std::int64_t width_px = 0;  // of a picture
  std::int64_t height_px = 0;
  std::int64_t file_bytes = 0;  // of a picture's file; 0 for a video
  SourceMemory memory = SourceMemory::kPicture;
};

struct PictureAnswer {
  PictureReply reply;
  // What the codecs printed about damage, or how the worker ended; one short line.
  std::string complaint;
  bool worker_ended = false;
};

// The process starts with the first request; if it has ended, the next request starts another. It needn't
// load the codecs: the decoder, a program beside this one, has loaded them once for all workers. The decoder
// starts with the first worker and ends with this program. Thread: one at a time; workers are independent.
class PictureWorker {
 public:
  explicit PictureWorker(const WorkerNeeds& needs);
  ~PictureWorker();
  PictureWorker(const PictureWorker&) = delete;
  PictureWorker& operator=(const PictureWorker&) = delete;

  // Waits for the answer, no longer than `most_time` if that is given. If the worker crashes or takes longer,
  // the answer says so. Throws: Error{kCancelled} within 50 ms of a stop; Error{kFile} when the decoder can't
  // be started.
  [[nodiscard]] PictureAnswer Ask(const PictureRequest& request, std::string_view text,
                                  const std::stop_token& stop,
                                  const std::optional<std::chrono::seconds>& most_time);

  // The memory for a picture's file and for its pixels.
  [[nodiscard]] std::span<std::byte> file_bytes() const;
  [[nodiscard]] std::span<std::byte> pixel_bytes() const;

 private:
  [[nodiscard]] bool is_running() const { return socket_.is_open(); }
  void Start(const std::stop_token& stop);
  void End();
  [[nodiscard]] PictureAnswer AnswerOfEnd();

  WorkerOrder order_;
  core::SharedMemory memory_;  // the pixels, then the file
  core::Descriptor socket_, leash_;
};

}  // namespace elbowroom::recon
