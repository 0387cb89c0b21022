#include "app/control/head/headset_watch.h"

#include <condition_variable>
#include <utility>

#include "app/control/head/headset_poses.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using recon::HeadsetNewsKind;
using recon::HeadsetPhase;

constexpr std::chrono::milliseconds kHearsStopWithin{15};

bool IsOver(HeadsetPhase phase) {
  return phase == HeadsetPhase::kLost || phase == HeadsetPhase::kRefused || phase == HeadsetPhase::kEnded;
}

void WaitUntilStopped(const std::stop_token& stop, std::chrono::milliseconds most) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  (void)never.wait_for(lock, stop, most, [] { return false; });
}

}  // namespace

HeadsetStatus HeadsetWatch::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

// That the headset was recentred is said until the session ends: the registration stays wrong.
void HeadsetWatch::SetPhase(HeadsetPhase phase, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (status_.phase == HeadsetPhase::kRecentred && !IsOver(phase)) return;
  status_.phase = phase;
  status_.text = text;
}

void HeadsetWatch::Run(const HeadSettings& settings, const OnPose& on_pose, const OnFault& on_fault,
                       const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    try {
      Follow(settings, on_pose, on_fault, stop);
    } catch (const core::Error& error) {  // the program isn't there
      SetPhase(HeadsetPhase::kRefused, error.what());
    }
    if (status().phase == HeadsetPhase::kEnded) return;  // its user wants no more of it
    WaitUntilStopped(stop, settings.headset_tried_again);
  }
}

void HeadsetWatch::Follow(const HeadSettings& settings, const OnPose& on_pose, const OnFault& on_fault,
                          const std::stop_token& stop) {
  recon::HeadsetLink link({screen_ ? 1 : 0, settings.space});
  const auto detach = [this](recon::HeadsetLink*) {
    if (screen_) screen_->Attach(nullptr);
  };
  const std::unique_ptr<recon::HeadsetLink, decltype(detach)> attached(&link, detach);
  if (screen_) screen_->Attach(&link);
  auto heard_at = HeadClock::now();
  std::optional<HeadsetStatus> before_silence;
  while (!stop.stop_requested()) {
    const auto news = link.Receive(kHearsStopWithin);
    if (!news) {
      if (!before_silence && HeadClock::now() - heard_at > settings.headset_patience) {
        before_silence = status();
        SetPhase(HeadsetPhase::kSilent, "the OpenXR runtime doesn't answer");
      }
      continue;
    }
    heard_at = HeadClock::now();
    if (const auto before = std::exchange(before_silence, std::nullopt))
      SetPhase(before->phase, before->text);
    switch (news->its.kind) {
      case HeadsetNewsKind::kStarted: {
        if (screen_) screen_->SetRecommended({news->its.recommended_px[0], news->its.recommended_px[1]});
        const std::lock_guard lock(mutex_);
        status_.name = news->text;
        break;
      }
      case HeadsetNewsKind::kPhase:
        SetPhase(news->its.phase, news->text);
        if (IsOver(news->its.phase)) return;
        break;
      case HeadsetNewsKind::kPose: {
        const auto pose = news->its.is_tracked != 0 ? HeadPoseOf(news->its, settings) : std::nullopt;
        if (pose) {
          on_pose(*pose);
        } else {
          on_fault(news->its.is_tracked != 0 ? PoseFault::kMalformed : PoseFault::kNotSeen);
        }
        break;
      }
      case HeadsetNewsKind::kAlive:
      case HeadsetNewsKind::kSlotBack:
        break;
    }
  }
}

}  // namespace elbowroom::control
