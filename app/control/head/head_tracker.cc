#include "app/control/head/head_tracker.h"

#include <utility>
#include <variant>

#include "app/control/head/cap_watch.h"
#include "app/control/head/udp_port.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using recon::HeadPose;
using recon::HeadSource;

constexpr std::chrono::milliseconds kHearsStop{50};

}  // namespace

HeadTracker::HeadTracker(HeadSettings settings, std::optional<core::Rig> rig, OnHeadPose on_pose,
                         HeadLimits limits, std::shared_ptr<HeadsetScreen> screen)
    : settings_(std::move(settings)), on_pose_(std::move(on_pose)), holder_(limits) {
  switch (settings_.source) {
    case HeadSource::kFixed:
      return;  // state() gives it
    case HeadSource::kOpenTrack:
    case HeadSource::kFreeD: {
      UdpPort port(settings_.address, settings_.port_or_default());
      port_ = port.port();
      thread_ = std::jthread([this, shared = std::make_shared<UdpPort>(std::move(port))](
                                 const std::stop_token& stop) { RunPackets(*shared, stop); });
      return;
    }
    case HeadSource::kCap:
      if (!rig)
        throw core::Error(core::ErrorKind::kCamera,
                          "the cap is found in the cameras' pictures: start a trial with calibrated cameras");
      thread_ =
          std::jthread([this, watch = std::make_shared<CapWatch>(settings_.cap, *rig)] { RunCap(*watch); });
      return;
    case HeadSource::kOpenXr:
      headset_ = std::make_unique<HeadsetWatch>(std::move(screen));
      thread_ = std::jthread([this](const std::stop_token& stop) {
        headset_->Run(
            settings_, [this](const HeadPose& pose) { Accept(pose); },
            [this](PoseFault fault) { holder_.CountFault(fault); }, stop);
      });
      return;
  }
}

std::optional<HeadsetStatus> HeadTracker::headset() const {
  return headset_ ? std::optional(headset_->status()) : std::nullopt;
}

HeadTracker::~HeadTracker() { frames_.Close(); }

HeadState HeadTracker::state() const {
  const auto now = HeadClock::now();
  if (settings_.source != HeadSource::kFixed) return holder_.StateAt(now);
  return {HeadPose{settings_.world_from_fixed_head, now, HeadSource::kFixed, {}, {}}, false, 1};
}

void HeadTracker::OfferFrames(SharedFrames frames) {
  if (settings_.source == HeadSource::kCap && frames) frames_.Push({std::move(frames), HeadClock::now()});
}

void HeadTracker::Accept(const HeadPose& pose) {
  if (!holder_.Offer(pose) && on_pose_) on_pose_(holder_.StateAt());
}

void HeadTracker::RunPackets(UdpPort& port, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto datagram = port.Receive(kHearsStop);
    if (!datagram) continue;
    const PacketResult result = settings_.source == HeadSource::kFreeD
                                    ? ReadFreeD(datagram->bytes, settings_.camera)
                                    : ReadOpenTrack(datagram->bytes);
    if (const auto* fault = std::get_if<PoseFault>(&result)) {
      holder_.CountFault(*fault);
      continue;
    }
    Accept({settings_.WorldFromHead(std::get<TrackerReading>(result)),
            datagram->came_at,
            settings_.source,
            {},
            {}});
  }
}

void HeadTracker::RunCap(const CapWatch& watch) {
  while (const auto next = frames_.Pop()) {
    const auto& [frames, came_at] = *next;
    try {
      const auto found = watch.Find(*frames);
      if (const auto* pose = std::get_if<recon::CapPose>(&found)) {
        Accept({pose->world_from_head, frames->taken_at.value_or(came_at), HeadSource::kCap, pose->sigma_mm(),
                pose->sigma_rad()});
        continue;
      }
    } catch (const std::exception&) {  // the thread's outermost loop: a picture that OpenCV refuses
    }
    holder_.CountFault(PoseFault::kNotSeen);
  }
}

}  // namespace elbowroom::control
