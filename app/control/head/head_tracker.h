// A head tracker that runs: it fills a HeadPoseHolder from a thread of its own.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "app/control/head/head_pose_holder.h"
#include "app/control/head/head_settings.h"
#include "app/control/head/headset_watch.h"
#include "core/bounded_queue.h"
#include "core/rig.h"
#include "recon/footage/frame_set.h"

namespace elbowroom::control {

// Called on the tracker's thread with each accepted pose; must not block.
using OnHeadPose = std::function<void(const HeadState&)>;

class CapWatch;
class UdpPort;

using SharedFrames = std::shared_ptr<const recon::FrameSet>;

// Thread: any; the destructor waits for the thread, which hears of it within 50 ms.
class HeadTracker {
 public:
  // fixed: the pose is offered again and again, so that it never is stale. opentrack, freed: packets of the
  // port. cap: the pictures of `rig`, which OfferFrames brings. openxr: the headset's, which shows what comes
  // to `screen`, if there is one; headset() says what is wrong with it. Throws: Error as UdpPort, for a cap
  // that CapFinder refuses, or a cap without a rig.
  HeadTracker(HeadSettings settings, std::optional<core::Rig> rig, OnHeadPose on_pose = {},
              HeadLimits limits = {}, std::shared_ptr<HeadsetScreen> screen = nullptr);
  ~HeadTracker();
  HeadTracker(const HeadTracker&) = delete;
  HeadTracker& operator=(const HeadTracker&) = delete;

  [[nodiscard]] const HeadSettings& settings() const { return settings_; }
  [[nodiscard]] HeadState state() const;
  [[nodiscard]] HeadCounts counts() const { return holder_.counts(); }
  // The one that is listened to; nothing without a network.
  [[nodiscard]] std::optional<int> port() const { return port_; }

  // Of openxr.
  [[nodiscard]] std::optional<HeadsetStatus> headset() const;

  // Pictures of an instant, for the cap: the latest wins. Does nothing for other sources.
  void OfferFrames(SharedFrames frames);

 private:
  void RunPackets(UdpPort& port, const std::stop_token& stop);
  void RunCap(const CapWatch& watch);
  void Accept(const recon::HeadPose& pose);

  HeadSettings settings_;
  OnHeadPose on_pose_;
  HeadPoseHolder holder_;
  std::optional<int> port_;
  std::unique_ptr<HeadsetWatch> headset_;
  core::BoundedQueue<std::pair<SharedFrames, HeadClock::time_point>> frames_{1, core::WhenFull::kDropOldest};
  std::jthread thread_;  // last: it starts when all other members exist
};

}  // namespace elbowroom::control
