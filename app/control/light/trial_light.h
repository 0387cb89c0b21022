// Watches the light of a trial's live cameras beside the judging.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/control/light/advice_log.h"
#include "core/bounded_queue.h"
#include "core/rig.h"
#include "core/session.h"
#include "recon/footage/frame_set.h"
#include "recon/light/light_watch.h"
#include "recon/segmentation/segmentation_options.h"

namespace elbowroom::control {

// Handed every report of a camera, on the watch's thread; must not block.
using OnLight = std::function<void(const recon::LightReport&)>;

// One recon::LightWatch a camera, on a thread of its own: a frame is handed over and never waited for. If the
// watch is kMostWaiting frames behind, it leaves the oldest out. Each camera is reported on every kReportS of
// the trial's time, one camera after the other. Cameras with ready masks aren't watched. The cost a frame:
// docs/light.md. Thread: one that calls.
class TrialLight {
 public:
  static constexpr double kReportS = 5.0;
  static constexpr std::size_t kMostWaiting = 4;

  // `segmentation`: valid for the rig. Throws: PreconditionError unless there is one background a camera.
  TrialLight(const core::Rig& rig, std::vector<recon::BackgroundReference> backgrounds,
             const recon::SegmentationOptions& segmentation, OnLight on_light = {});
  ~TrialLight();
  TrialLight(const TrialLight&) = delete;
  TrialLight& operator=(const TrialLight&) = delete;

  // A frame's pictures and masks, neither of which is written to from here on. Returns at once.
  void Offer(std::shared_ptr<const recon::FrameSet> frames, core::SharedMasks masks);

  // Notes for the session that came since the last call.
  [[nodiscard]] std::vector<std::string> TakeNotes();

  // Looks at what waits, then at nothing more. After it: the last report of each camera that was watched, and
  // the advice that was given.
  void Finish();
  [[nodiscard]] std::vector<recon::LightReport> reports() const;
  [[nodiscard]] const std::vector<std::string>& advice() const { return log_.given(); }

 private:
  struct Frame {
    std::shared_ptr<const recon::FrameSet> frames;
    core::SharedMasks masks;
  };

  void Prepare(const core::Rig& rig, const std::vector<recon::BackgroundReference>& backgrounds,
               const recon::SegmentationOptions& segmentation);
  void Watch();
  void Look(const Frame& frame);
  void Report(std::size_t camera);

  std::vector<std::optional<recon::LightWatch>> watches_;  // one a camera; nothing for one with ready masks
  OnLight on_light_;
  AdviceLog log_;
  std::optional<double> next_report_s_;
  std::size_t next_camera_ = 0;
  std::vector<std::optional<recon::LightReport>> latest_;  // one a camera
  core::BoundedQueue<Frame> waiting_{kMostWaiting, core::WhenFull::kDropOldest};
  std::mutex mutex_;  // for notes_
  std::vector<std::string> notes_;
  std::jthread thread_;
};

}  // namespace elbowroom::control
