// The thread that writes a recording to the disk, and goes on while the disk fails for a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/bounded_queue.h"
#include "sessions/recording_store.h"
#include "sessions/session_writer.h"

namespace elbowroom::sessions {

// Takes entries from a queue, gathers them for a moment, and commits them together. Thread: any number may
// push; Stop() and store() are called when no other call is under way.
class RecordingThread {
 public:
  RecordingThread(RecordingStore store, SessionWriterOptions options);
  ~RecordingThread();
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  // Waits for room. Throws: what ended the recording.
  void Push(RecordingEntry entry);

  // Waits until everything pushed is written. What prevented it is kept for ThrowIfFailed().
  void Stop();
  [[nodiscard]] bool is_stopped() const { return !thread_.joinable(); }
  void ThrowIfFailed();
  [[nodiscard]] bool has_failed() const;

  // Only after Stop().
  [[nodiscard]] RecordingStore& store() { return store_; }

  [[nodiscard]] std::int64_t frames_committed() const;
  [[nodiscard]] RecordingState state() const;
  [[nodiscard]] std::filesystem::path path() const;

 private:
  using Clock = std::chrono::steady_clock;
  // Since when, and why, nothing could be written.
  struct Trouble {
    Clock::time_point since;
    std::string why;
  };

  void Run() noexcept;
  [[nodiscard]] bool Gather();
  void Hold(RecordingEntry entry);
  [[nodiscard]] bool IsFull() const;
  void WriteHeld();
  void WaitOrThrow(const core::Error& error);
  void TrySpill();
  void TryToReturn();
  void ThrowIfTooLong(const core::Error& error);
  void Report(RecordingState state, const std::string& line);

  RecordingStore store_;
  const SessionWriterOptions options_;
  core::BoundedQueue<RecordingEntry> queue_;
  std::vector<RecordingEntry> held_;  // not on the disk yet, in order
  std::int64_t held_frames_ = 0;
  std::int64_t held_bytes_ = 0;
  std::optional<Trouble> trouble_;
  std::optional<Clock::time_point> out_of_room_since_;  // memory is full, or the queue is closed
  Clock::time_point next_return_;                       // when ReturnFromSpill() is tried next

  mutable std::mutex mutex_;  // guards the next four members
  std::int64_t frames_committed_ = 0;
  RecordingState state_ = RecordingState::kInFile;
  std::filesystem::path path_;
  std::exception_ptr failure_;

  std::thread thread_;
};

}  // namespace elbowroom::sessions
