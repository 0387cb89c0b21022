// An OpenXR headset that is followed.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>

#include "app/control/head/head_pose_holder.h"
#include "app/control/head/head_settings.h"
#include "app/control/head/headset_screen.h"

namespace elbowroom::control {

struct HeadsetStatus {
  recon::HeadsetPhase phase = recon::HeadsetPhase::kStarting;
  std::string name;  // of runtime and headset; empty: not known yet
  std::string text;  // why, in one line, where there is a reason
};

// Runs the headset program, and starts it again every few seconds when the runtime is gone or can't be used.
// Thread: status() any; Run one.
class HeadsetWatch {
 public:
  using OnPose = std::function<void(const recon::HeadPose&)>;
  using OnFault = std::function<void(PoseFault)>;

  // With a screen the headset shows pictures.
  explicit HeadsetWatch(std::shared_ptr<HeadsetScreen> screen) : screen_(std::move(screen)) {}

  void Run(const HeadSettings& settings, const OnPose& on_pose, const OnFault& on_fault,
           const std::stop_token& stop);
  [[nodiscard]] HeadsetStatus status() const;

 private:
  void Follow(const HeadSettings& settings, const OnPose& on_pose, const OnFault& on_fault,
              const std::stop_token& stop);
  void SetPhase(recon::HeadsetPhase phase, const std::string& text);

  std::shared_ptr<HeadsetScreen> screen_;  // null: poses only
  mutable std::mutex mutex_;
  HeadsetStatus status_;
};

}  // namespace elbowroom::control
