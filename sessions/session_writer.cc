#include "sessions/session_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "core/error.h"
#include "sessions/event_rows.h"
#include "sessions/recording_thread.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;
using core::Require;

void RequireFits(const core::FrameRecord& record, const core::SessionHeader& header) {
  Require(record.masks && record.masks->size() == header.rig.cameras.size(), "one silhouette a camera");
  for (core::CameraIndex i = 0; i < header.rig.cameras.size(); ++i) {
    const core::SoftMask& silhouette = (*record.masks)[i];
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
  Require(record.stamps.empty() || record.stamps.size() == header.rig.cameras.size(),
          "one stamp a camera, or none");
  for (const std::optional<core::CameraStamp>& stamp : record.stamps)
    Require(!stamp || (std::isfinite(stamp->time_s) && std::in_range<std::int64_t>(stamp->picture)),
            "a stamp has a time, and a count that fits in 63 bits");
}

}  // namespace

struct SessionWriter::Impl {
  Impl(const std::filesystem::path& path, core::SessionHeader set_up, SessionWriterOptions options)
      : header(std::move(set_up)), thread(RecordingStore(path, header), std::move(options)) {}

  const core::SessionHeader header;
  // What was recorded stays. If nothing could be recorded, the files are removed.
  void Close() {
    thread.Stop();
    if (thread.has_failed() && thread.frames_committed() == 0) {
      thread.store().Remove();
    } else {
      thread.store().Close();
    }
  }

  RecordingThread thread;
  bool is_over = false;  // finished or abandoned
};

SessionWriter::SessionWriter(const std::filesystem::path& path, core::SessionHeader header,
                             SessionWriterOptions options)
    : impl_(std::make_unique<Impl>(path, std::move(header), std::move(options))) {}

SessionWriter::~SessionWriter() {
  if (!impl_->is_over) impl_->Close();
}

void SessionWriter::Append(core::FrameRecord record) {
  RequireFits(record, impl_->header);
  impl_->thread.Push(std::move(record));
}

void SessionWriter::Append(core::SessionEvent event) {
  RequireOfSetUp(event.what, impl_->header);
  impl_->thread.Push(std::move(event));
}

void SessionWriter::Finish(core::SessionOutcome outcome, SessionClosing closing) {
  Require(!std::exchange(impl_->is_over, true), "a session is finished or abandoned once");
  try {
    impl_->thread.Push(SessionEnd{std::move(outcome), std::move(closing)});
    impl_->thread.Stop();
    impl_->thread.ThrowIfFailed();
  } catch (...) {
    impl_->Close();
    throw;
  }
  impl_->Close();
}

void SessionWriter::Abandon() {
  Require(!std::exchange(impl_->is_over, true), "a session is finished or abandoned once");
  impl_->thread.Stop();
  Require(frames_committed() == 0, "only a session without a frame is abandoned");
  const std::filesystem::path path = impl_->thread.store().path();
  if (!impl_->thread.store().Remove()) {
    throw Error(ErrorKind::kFile, fmt::format("session '{}': no frame was recorded, and the empty file can't "
                                              "be removed; it may be deleted",
                                              path.string()));
  }
}

std::int64_t SessionWriter::frames_committed() const { return impl_->thread.frames_committed(); }
RecordingState SessionWriter::state() const { return impl_->thread.state(); }
std::filesystem::path SessionWriter::path() const { return impl_->thread.path(); }

}  // namespace elbowroom::sessions
