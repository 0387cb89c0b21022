#include "recon/capture/camera_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/system/child_process.h"
#include "recon/capture/camera_program.h"
#include "recon/capture/device/camera_protocol.h"
#include "recon/capture/picture_counter.h"
#include "recon/capture/picture_pool.h"
#include "recon/capture/shared_slots.h"
#include "recon/decoding/packet.h"

namespace elbowroom::recon {
namespace {

using core::LossReason;
using core::Woken;
using std::chrono::milliseconds;

// Opening a camera may need several packets that nobody answers; a stream may have to be found.
constexpr std::chrono::seconds kLongestStart{15};
// A program that gives no sign of life for so long hangs.
constexpr milliseconds kLongestWithoutSign{1500};
// A program whose camera is gone can't let go of it in order; it is killed then.
constexpr milliseconds kLongestEnd{300};
constexpr milliseconds kBetweenTries{100};
constexpr double kPeriodsOfSilence = 8.0;

CaptureClock::time_point AtNs(std::int64_t ns) {
  return CaptureClock::time_point(std::chrono::nanoseconds(ns));
}

LossReason ReasonOf(PictureState state) {
  switch (state) {
    case PictureState::kWhole:
      return LossReason::kNoRoom;  // it found no slot
    case PictureState::kIncomplete:
      return LossReason::kIncomplete;
    case PictureState::kDamaged:
      return LossReason::kDamaged;
  }
  throw core::PreconditionError("this state has no reason");
}

}  // namespace

// What lasts over the interruptions of one camera.
class CameraLink::Session {
 public:
  explicit Session(CameraLink& link)
      : link_(link),
        slots_(cv::Size(link.request_.width_px, link.request_.height_px)),
        pool_(cv::Size(link.request_.width_px, link.request_.height_px)),
        counter_(link.handlers_.on_loss) {
    if (link.request_.settings.rate_hz) counter_.SetRate(*link.request_.settings.rate_hz);
  }

  // Runs the camera's program until it ends; returns what was wrong.
  std::string RunOnce(const std::stop_token& stop) {
    CameraProgram program(&slots_);
    socket_ = std::move(program.socket);
    is_running_ = false;
    counter_.Interrupt();
    last_picture_ = last_sign_ = CaptureClock::now();
    if (!SendPacket(socket_, OrderFor(link_.request_), link_.request_.location))
      return "its program ends at once";
    std::optional<std::string> trouble;
    while (!trouble && !stop.stop_requested()) trouble = Step(program.child, stop);
    socket_.Close();  // it lets go of the camera then
    (void)program.child.WaitForEnd({}, CaptureClock::now() + kLongestEnd);
    return trouble.value_or("");
  }

  [[nodiscard]] const CameraState& state() const { return state_; }

  void Tell(CameraPresence presence, const std::string& trouble = {}) {
    if (state_.presence == presence && state_.trouble == trouble) return;
    state_.presence = presence;
    state_.trouble = trouble;
    link_.handlers_.on_state(state_);
  }

 private:
  // One wait and what comes of it; what is wrong, if anything is.
  std::optional<std::string> Step(core::Child& child, const std::stop_token& stop) {
    PassTriggersOn();
    constexpr milliseconds kLook{20};
    switch (core::WaitToRead(socket_, stop, CaptureClock::now() + kLook)) {
      case Woken::kStopped:
        return std::nullopt;
      case Woken::kTooLate:
        return WhatIsOverdue();
      case Woken::kReady:
        break;
    }
    const std::optional<Packet> packet = ReceivePacket(socket_);
    const auto news = packet ? packet->Head<CameraNews>() : std::nullopt;
    if (!news) return "its program " + core::TextOfEnd(child.Wait());
    last_sign_ = CaptureClock::now();
    return Take(*news, packet->Text<CameraNews>());
  }

  std::optional<std::string> Take(const CameraNews& news, std::string_view text) {
    switch (news.kind) {
      case CameraNewsKind::kStarted:
        is_running_ = true;
        last_picture_ = CaptureClock::now();
        state_.report = ReportOf(news, text);
        if (state_.report.rate_hz && *state_.report.rate_hz > 0.0) counter_.SetRate(*state_.report.rate_hz);
        Tell(CameraPresence::kRunning);
        return std::nullopt;
      case CameraNewsKind::kPicture:
        TakePicture(news);
        return std::nullopt;
      case CameraNewsKind::kAlive:
        return WhatIsOverdue();
      case CameraNewsKind::kListed:
        break;
      case CameraNewsKind::kFailed:
        return core::PrintableLine(text, kLongestPacketBytes);
    }
    return "its program says what isn't understood";
  }

  void TakePicture(const CameraNews& news) {
    last_picture_ = last_sign_;
    const DevicePicture& picture = news.picture;
    const CaptureClock::time_point taken_at = AtNs(picture.taken_ns);
    if (news.slot < 0 || news.slot >= kPictureSlots) {
      counter_.CountLost(picture.number, taken_at, ReasonOf(picture.state));
      return;
    }
    CapturedPicture captured{pool_.Take(), 0, taken_at, AtNs(picture.arrived_ns), picture.stamp_source};
    slots_.Slot(news.slot).copyTo(captured.image_bgr);
    (void)SendPacket(socket_, CommandToCamera{CameraCommand::kSlotBack, news.slot});
    captured.number = counter_.Count(picture.number, taken_at);
    link_.handlers_.on_picture(std::move(captured));
  }

  [[nodiscard]] std::optional<std::string> WhatIsOverdue() const {
    const auto now = CaptureClock::now();
    if (!is_running_) {
      if (now - last_picture_ > kLongestStart) return "it doesn't start";
      return std::nullopt;
    }
    if (now - last_sign_ > kLongestWithoutSign) return "its program hangs";
    const std::chrono::duration<double> silence =
        std::max(std::chrono::duration<double>(kLongestSilence),
                 std::chrono::duration<double>(kPeriodsOfSilence * counter_.period_s()));
    if (link_.request_.settings.trigger == CaptureTrigger::kFree && now - last_picture_ > silence)
      return fmt::format("no picture came for {:.0f} ms", silence.count() * 1000.0);
    return std::nullopt;
  }

  void PassTriggersOn() {
    const std::lock_guard lock(link_.mutex_);
    for (; link_.triggers_ > 0; --link_.triggers_)
      if (is_running_) (void)SendPacket(socket_, CommandToCamera{CameraCommand::kTrigger, 0});
  }

  CameraLink& link_;
  SharedSlots slots_;
  PicturePool pool_;
  PictureCounter counter_;
  CameraState state_;
  core::Descriptor socket_;
  bool is_running_ = false;
  CaptureClock::time_point last_picture_, last_sign_;
};

CameraLink::CameraLink(DeviceRequest request, CaptureHandlers handlers)
    : request_(std::move(request)),
      handlers_(std::move(handlers)),
      thread_([this](const std::stop_token& stop) { Run(stop); }) {}

CameraLink::~CameraLink() = default;

void CameraLink::Trigger() {
  const std::lock_guard lock(mutex_);
  ++triggers_;
}

void CameraLink::Run(const std::stop_token& stop) {
  std::optional<Session> session;
  while (!stop.stop_requested()) {
    std::string trouble;
    try {
      if (!session) session.emplace(*this);
      trouble = session->RunOnce(stop);
    } catch (const core::Error& error) {
      trouble = error.what();
    }
    if (stop.stop_requested()) return;
    if (session) {
      session->Tell(CameraPresence::kGone, trouble);
    } else {
      handlers_.on_state({CameraPresence::kGone, {}, trouble});
    }
    std::unique_lock lock(mutex_);
    wakes_.wait_for(lock, stop, kBetweenTries, [] { return false; });
  }
}

}  // namespace elbowroom::recon
