#include "app/control/watch/knock_watch.h"

#include <fmt/format.h>

#include <memory>

#include "recon/consistency/tangencies.h"
#include "recon/contours/undistorted_plane.h"

namespace elbowroom::control {

const char* ToString(KnockState state) {
  switch (state) {
    case KnockState::kLearning:
      return "learning";
    case KnockState::kSteady:
      return "steady";
    case KnockState::kNamed:
      return "named";
    case KnockState::kUnnamed:
      return "unnamed";
  }
  return "";
}

KnockWatch::KnockWatch(const core::Rig& rig, const recon::WatchOptions& options)
    : pairs_(std::make_shared<const recon::EpipolarPairs>(rig, recon::MakeUndistortedPlanes(rig))),
      block_s_(options.block_s),
      watch_(pairs_, options) {
  for (const core::CameraModel& camera : rig.cameras) names_.push_back(camera.name());
}

std::optional<std::string> KnockWatch::Add(const core::FrameRecord& frame) {
  if (pairs_->pairs().empty() || frame.LacksCamera() || frame.masks == last_masks_) {
    ++report_.frames_skipped;
    return std::nullopt;
  }
  last_masks_ = frame.masks;
  recon::FrameTangencies tangencies = recon::FindTangencies(*pairs_, *frame.masks);
  if (tangencies.found.empty()) {
    ++report_.frames_skipped;
    return std::nullopt;
  }
  ++report_.frames_compared;
  now_s_ = frame.time_s;
  watch_.Add(frame.time_s, std::move(tangencies));
  const std::string before = report_.advice;
  WriteReport();
  if (report_.advice == before) return std::nullopt;
  return report_.advice;
}

// More evidence names most knocks some seconds after they are noticed, so it is waited for.
KnockState KnockWatch::StateNow() const {
  constexpr double kWaitForNameS = 10.0;
  const recon::WatchState& state = watch_.state();
  if (state.is_learning) return KnockState::kLearning;
  if (state.moved) return KnockState::kNamed;
  if (unnamed_since_s_ && now_s_ - *unnamed_since_s_ >= kWaitForNameS) return KnockState::kUnnamed;
  return KnockState::kSteady;
}

std::vector<std::string> KnockWatch::NamesOf(const std::vector<core::CameraIndex>& cameras) const {
  std::vector<std::string> names;
  for (const core::CameraIndex camera : cameras) names.push_back(names_[camera]);
  return names;
}

// What was said of a camera first stays: more evidence changes its figures only.
void KnockWatch::WriteReport() {
  constexpr const char* kWhatToDo =
      "verdicts from there on are off by that, by an amount that no uncertainty has in it; stop, fix the "
      "camera, and calibrate again";
  const recon::WatchState& state = watch_.state();
  if (state.has_changed && !unnamed_since_s_) unnamed_since_s_ = now_s_;
  report_.evidence_s = state.blocks * block_s_;
  report_.noise_factor = state.noise_factor;
  const KnockState before = report_.state;
  report_.state = StateNow();
  if (report_.state == KnockState::kNamed) {
    const recon::CameraMoved& moved = *state.moved;
    const std::vector<std::string> named = NamesOf({moved.camera});
    const bool is_new = before != KnockState::kNamed || report_.cameras != named;
    report_.cameras = named;
    report_.since_s = moved.since_s;
    report_.shift_px = moved.shift_px;
    report_.shift_sigma_px = moved.shift_sigma_px;
    if (!is_new) return;
    report_.advice = fmt::format(
        "camera '{}' was knocked: from {:.0f} s on its picture is shifted by {:.2f} px (standard uncertainty "
        "{:.2f} px); {}",
        named.front(), moved.since_s, moved.shift_px, moved.shift_sigma_px, kWhatToDo);
  } else if (report_.state == KnockState::kUnnamed) {
    report_.cameras = NamesOf(state.suspects);
    if (before == KnockState::kUnnamed) return;
    report_.advice = fmt::format("a camera was knocked before {:.0f} s, one of '{}': {}", *unnamed_since_s_,
                                 fmt::join(report_.cameras, "', '"), kWhatToDo);
  }
}

}  // namespace elbowroom::control
