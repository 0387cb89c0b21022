#include "sessions/session_writer.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "core/bounded_queue.h"
#include "core/error.h"
#include "sessions/database.h"
#include "sessions/frame_rows.h"
#include "sessions/header_rows.h"
#include "sessions/outcome_rows.h"
#include "sessions/schema.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;
using core::Require;
using Entry = std::variant<core::FrameRecord, core::SessionEvent>;

constexpr std::size_t kQueueCapacity = 64;  // frames: two seconds at 30 Hz
constexpr int kEntriesPerTransaction = 64;  // at most; an idle writer commits each frame as it comes

Database CreateSession(const std::filesystem::path& path, const core::SessionHeader& header) {
  header.rig.Validate();
  header.layout.Validate();
  Database database = Database::Create(path);
  try {
    Transaction transaction(database);
    Migrate(database);
    InsertHeader(database, header);
    transaction.Commit();
  } catch (...) {
    RemoveDatabaseFiles(path);
    throw;
  }
  return database;
}

std::string NowUtc() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

void RequireFits(const core::FrameRecord& record, const core::SessionHeader& header) {
  Require(record.silhouettes && record.silhouettes->size() == header.rig.cameras.size(),
          "one silhouette a camera");
  for (core::CameraIndex i = 0; i < header.rig.cameras.size(); ++i) {
    const core::SoftMask& silhouette = (*record.silhouettes)[i];
    const core::CameraModel& camera = header.rig.cameras[i];
    Require(
        silhouette.mask.width_px() == camera.width_px() && silhouette.mask.height_px() == camera.height_px(),
        "a silhouette has its camera's size");
    silhouette.Validate();
  }
  Require(record.spacing_mm.size() == header.layout.spacings.size(), "one value a spacing");
  Require(record.contacts.size() == header.layout.parts.size(), "one contact a part");
  for (core::PartIndex i = 0; i < record.contacts.size(); ++i) {
    Require(record.contacts[i].part == i, "contacts come in the layout's order of parts");
  }
  Require(record.rest_from_parts.empty() || record.rest_from_parts.size() == header.layout.parts.size(),
          "one motion a part, or none");
}

}  // namespace

struct SessionWriter::Impl {
  Impl(const std::filesystem::path& path, core::SessionHeader set_up)
      : header(std::move(set_up)), database(CreateSession(path, header)), frames(std::in_place, database) {
    thread = std::thread([this] { WriteUntilClosed(); });
  }

  void Append(Entry entry) {
    Require(thread.joinable(), "nothing is appended after Finish() or Abandon()");
    if (!queue.Push(std::move(entry))) RethrowFailure();
  }

  void WriteUntilClosed() noexcept {
    try {
      while (auto entry = queue.Pop()) WriteBatch(*std::move(entry));
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      failure = std::current_exception();
      queue.Close();
    }
  }

  void WriteBatch(Entry first) {
    Transaction transaction(database);
    std::int64_t frames_written = 0;
    std::optional<Entry> entry(std::move(first));
    for (int i = 1; entry; ++i) {
      if (const auto* record = std::get_if<core::FrameRecord>(&*entry)) {
        frames->Insert(*record);
        ++frames_written;
      } else {
        InsertEvent(database, header.layout, std::get<core::SessionEvent>(*entry));
      }
      entry = i < kEntriesPerTransaction ? queue.TryPop() : std::nullopt;
    }
    transaction.Commit();
    frames_committed += frames_written;
  }

  // Afterwards this thread owns the connection.
  void DrainAndStop() {
    queue.Close();
    if (thread.joinable()) thread.join();
    frames.reset();
  }

  void RethrowFailure() {
    const std::lock_guard lock(failure_mutex);
    if (failure) std::rethrow_exception(failure);
  }

  const core::SessionHeader header;
  Database database;
  std::optional<FrameInserter> frames;
  core::BoundedQueue<Entry> queue{kQueueCapacity, core::WhenFull::kBlock};
  std::atomic<std::int64_t> frames_committed{0};
  std::mutex failure_mutex;
  std::exception_ptr failure;
  std::thread thread;
};

SessionWriter::SessionWriter(const std::filesystem::path& path, core::SessionHeader header)
    : impl_(std::make_unique<Impl>(path, std::move(header))) {}

SessionWriter::~SessionWriter() {
  if (!impl_->thread.joinable()) return;
  impl_->DrainAndStop();
  try {
    impl_->database.FoldLogIntoFile();
  } catch (const Error&) {
    // The log stays beside the file: a reader finds every committed frame in the two.
    return;
  }
}

void SessionWriter::Append(core::FrameRecord record) {
  RequireFits(record, impl_->header);
  impl_->Append(std::move(record));
}

void SessionWriter::Append(core::SessionEvent event) {
  if (const auto* change = std::get_if<core::SpacingChanged>(&event.what)) {
    Require(impl_->header.layout.FindSpacing(change->spacing).has_value(),
            "a changed spacing is one of the layout's");
  }
  impl_->Append(std::move(event));
}

void SessionWriter::Finish(const core::SessionOutcome& outcome) {
  Require(impl_->thread.joinable(), "a session is finished or abandoned once");
  impl_->DrainAndStop();
  impl_->RethrowFailure();
  Transaction transaction(impl_->database);
  InsertOutcome(impl_->database, outcome);
  impl_->database.Execute(
      fmt::format("UPDATE session SET status = 'complete', ended_at_utc = '{}'", NowUtc()));
  transaction.Commit();
  impl_->database.FoldLogIntoFile();
}

void SessionWriter::Abandon() {
  Require(impl_->thread.joinable(), "a session is finished or abandoned once");
  impl_->DrainAndStop();
  try {
    // For a program that is reading along.
    impl_->database.Execute(
        fmt::format("UPDATE session SET status = 'abandoned', ended_at_utc = '{}'", NowUtc()));
  } catch (const Error&) {
    impl_->failure = nullptr;  // whatever is wrong with the file, it goes now
  }
  const std::filesystem::path path = impl_->database.path();
  if (!RemoveDatabaseFiles(path)) {
    throw Error(ErrorKind::kFile,
                fmt::format("can't remove the unfinished session '{}'; remove it by hand", path.string()));
  }
}

std::int64_t SessionWriter::frames_committed() const { return impl_->frames_committed; }

}  // namespace elbowroom::sessions
