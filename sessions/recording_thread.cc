#include "sessions/recording_thread.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace elbowroom::sessions {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kQueueCapacity = 64;  // frames: two seconds at 30 Hz
// A commit waits this long for further entries, so that one sync of the disk serves several frames.
constexpr milliseconds kGatherFor(50);
constexpr std::size_t kMostGathered = 64;
constexpr milliseconds kRetryAfter(100);
// How often a recording without frames checks that its file is still there, and how often a recording in a
// spill tries to return to the session file.
constexpr milliseconds kLookAfter(500);
constexpr std::int64_t kMostHeldBytes = 256'000'000;

std::int64_t BytesOf(const RecordingEntry& entry) {
  const auto* record = std::get_if<core::FrameRecord>(&entry);
  if (record == nullptr) return 0;
  std::size_t bytes = 0;
  for (const core::SoftMask& mask : *record->masks)
    bytes += mask.mask.words().size_bytes() + mask.levels.size();
  for (const core::PartContact& contact : record->contacts)
    bytes += sizeof contact + contact.points.size() * sizeof(core::ContactPoint);
  return static_cast<std::int64_t>(bytes);
}

}  // namespace

RecordingThread::RecordingThread(RecordingStore store, SessionWriterOptions options)
    : store_(std::move(store)),
      options_(std::move(options)),
      queue_(kQueueCapacity, core::WhenFull::kBlock),
      path_(store_.path()),
      thread_([this] { Run(); }) {}

RecordingThread::~RecordingThread() { Stop(); }

void RecordingThread::Push(RecordingEntry entry) {
  core::Require(!is_stopped(), "nothing is appended after Finish() or Abandon()");
  if (!queue_.Push(std::move(entry))) ThrowIfFailed();
}

void RecordingThread::Stop() {
  queue_.Close();
  if (thread_.joinable()) thread_.join();
}

void RecordingThread::ThrowIfFailed() {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

bool RecordingThread::has_failed() const {
  const std::lock_guard lock(mutex_);
  return failure_ != nullptr;
}

std::int64_t RecordingThread::frames_committed() const {
  const std::lock_guard lock(mutex_);
  return frames_committed_;
}

RecordingState RecordingThread::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::filesystem::path RecordingThread::path() const {
  const std::lock_guard lock(mutex_);
  return path_;
}

void RecordingThread::Run() noexcept {
  try {
    while (Gather()) WriteHeld();
    if (store_.is_spilling()) TryToReturn();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    queue_.Close();
  }
}

void RecordingThread::Hold(RecordingEntry entry) {
  held_frames_ += std::holds_alternative<core::FrameRecord>(entry) ? 1 : 0;
  held_bytes_ += BytesOf(entry);
  held_.push_back(std::move(entry));
}

bool RecordingThread::IsFull() const {
  return held_frames_ >= options_.most_held_frames || held_bytes_ >= kMostHeldBytes;
}

// Takes entries until it is time to write; false when there is nothing more to do.
bool RecordingThread::Gather() {
  const Clock::time_point begin = Clock::now();
  if (trouble_) {
    // Entries that come meanwhile are kept, so that the trial goes on.
    const Clock::time_point retry = begin + kRetryAfter;
    while (!IsFull() && Clock::now() < retry) {
      auto entry = queue_.PopUntil(retry);
      if (!entry) break;
      Hold(*std::move(entry));
    }
    const bool no_more = IsFull() || queue_.is_closed();
    if (!no_more) {
      out_of_room_since_.reset();
    } else {
      if (!out_of_room_since_) out_of_room_since_ = begin;
      std::this_thread::sleep_until(retry);
    }
    return true;
  }
  auto first = queue_.PopUntil(begin + kLookAfter);
  if (!first) return !queue_.is_closed();
  Hold(*std::move(first));
  const bool is_first_frame = frames_committed() == 0;
  const Clock::time_point write_at = Clock::now() + kGatherFor;
  while (!is_first_frame && held_.size() < kMostGathered) {
    auto entry = queue_.PopUntil(write_at);
    if (!entry) break;
    Hold(*std::move(entry));
  }
  return true;
}

void RecordingThread::WriteHeld() {
  try {
    if (store_.RestoreIfGone()) {
      {
        const std::lock_guard lock(mutex_);
        path_ = store_.path();
      }
      Report(state(), fmt::format("the session file was removed or replaced while it was recorded; '{}' is "
                                  "written again, with every frame so far",
                                  store_.path().string()));
    }
    if (!held_.empty()) store_.Write(held_);
  } catch (const DatabaseError& error) {
    if (!error.MayPass()) throw;
    return WaitOrThrow(error);
  } catch (const core::Error& error) {
    return WaitOrThrow(error);
  }
  {
    const std::lock_guard lock(mutex_);
    frames_committed_ += held_frames_;
  }
  held_.clear();
  held_frames_ = held_bytes_ = 0;
  out_of_room_since_.reset();
  if (std::exchange(trouble_, std::nullopt) && !store_.is_spilling())
    Report(RecordingState::kInFile, "the session file is written again; no frame was lost");
  if (store_.is_spilling()) TryToReturn();
}

void RecordingThread::WaitOrThrow(const core::Error& error) {
  if (!trouble_) {
    trouble_ = Trouble{Clock::now(), error.what()};
    Report(RecordingState::kInMemory, fmt::format("{}; frames are kept in memory meanwhile", error.what()));
  }
  const bool is_time =
      Clock::now() - trouble_->since >= std::chrono::duration<double>(options_.spill_after_s);
  if (store_.is_spilling()) {
    TryToReturn();
  } else if (is_time || queue_.is_closed()) {
    TrySpill();
  }
  ThrowIfTooLong(error);
}

void RecordingThread::TrySpill() {
  try {
    store_.SpillBeside();
  } catch (const core::Error&) {
    return;  // most likely the same disk: the entries stay in memory
  }
  next_return_ = Clock::now() + kLookAfter;
  Report(RecordingState::kInSpill, fmt::format("{}; frames go into '{}.spill' meanwhile", trouble_->why,
                                               store_.path().filename().string()));
}

void RecordingThread::TryToReturn() {
  const bool is_last = queue_.is_closed();
  if (!is_last && Clock::now() < next_return_) return;
  next_return_ = Clock::now() + kLookAfter;
  try {
    store_.ReturnFromSpill();
  } catch (const DatabaseError&) {
    return;  // the session file still can't be written: the spill holds everything
  }
  Report(RecordingState::kInFile, "the session file is written again; no frame was lost");
}

void RecordingThread::ThrowIfTooLong(const core::Error& error) {
  if (!out_of_room_since_) return;
  if (Clock::now() - *out_of_room_since_ < std::chrono::duration<double>(options_.patience_s)) return;
  throw core::Error(error.kind(), error.what());
}

void RecordingThread::Report(RecordingState state, const std::string& line) {
  {
    const std::lock_guard lock(mutex_);
    state_ = state;
  }
  if (options_.on_news) options_.on_news({state, line});
}

}  // namespace elbowroom::sessions
