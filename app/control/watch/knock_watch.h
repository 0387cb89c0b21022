// Tells a trial that one of its rig's cameras was knocked: that it was turned or moved while people worked.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/rig.h"
#include "core/session.h"
#include "recon/consistency/rig_watch.h"

namespace elbowroom::control {

enum class KnockState {
  kLearning,  // too little was seen yet to judge by
  kSteady,    // all cameras stand as they did
  kNamed,     // one camera was knocked, and it is known which
  kUnnamed,   // one was knocked; which one of some can't be told
};

// "learning", "steady", "named", "unnamed".
[[nodiscard]] const char* ToString(KnockState state);

struct KnockReport {
  KnockState state = KnockState::kLearning;
  double evidence_s = 0.0;           // how long hands were seen by two cameras or more
  std::int64_t frames_compared = 0;  // with a tangency
  std::int64_t frames_skipped = 0;   // a camera lacking, the same silhouettes as before, or no tangency
  double noise_factor = 1.0;         // the residuals' scatter over their sigma
  // kNamed: that camera; kUnnamed: those that may be it, the likeliest first.
  std::vector<std::string> cameras;
  // Of the one that is named.
  std::optional<double> since_s;  // in the trial's time: the earliest of the evidence
  std::optional<double> shift_px, shift_sigma_px;
  std::string advice;  // one line; "": nothing is to be done
};

// A recon::RigWatch, fed with a trial's silhouettes. A rig whose cameras make no pair stays kLearning. The
// cost a frame: docs/consistency.md. Thread: one at a time.
class KnockWatch {
 public:
  explicit KnockWatch(const core::Rig& rig, const recon::WatchOptions& options = {});

  // Frames in the order of time. Returns advice that is new.
  [[nodiscard]] std::optional<std::string> Add(const core::FrameRecord& frame);

  [[nodiscard]] const KnockReport& report() const { return report_; }

 private:
  [[nodiscard]] KnockState StateNow() const;
  [[nodiscard]] std::vector<std::string> NamesOf(const std::vector<core::CameraIndex>& cameras) const;
  void WriteReport();

  std::vector<std::string> names_;  // of the cameras
  std::shared_ptr<const recon::EpipolarPairs> pairs_;
  double block_s_ = 1.0;
  recon::RigWatch watch_;
  core::SharedMasks last_masks_;
  std::optional<double> unnamed_since_s_;  // when a knock was noticed that nothing could name
  double now_s_ = 0.0;
  KnockReport report_;
};

}  // namespace elbowroom::control
