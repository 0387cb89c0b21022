// The recorded motion frame by frame, in any order: hulls, and how fast their contours moved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "app/control/frame_result.h"
#include "core/rig.h"
#include "core/session.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/error_budget/motion_history.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

struct MotionFrame {
  core::FrameRecord record;
  SharedHull hull;
  std::shared_ptr<const recon::SkewErrors> skew_errors;  // null: motion doesn't count
};

// Makes a frame's hull from its silhouettes; silhouettes that stay keep theirs. Thread: one.
class RecordedMotion {
 public:
  using FrameReader = std::function<core::FrameRecord(core::FrameIndex)>;
  // Gives a hull's new silhouettes the contours that are kept (recon::ContourGiver). True: none is left to be
  // made.
  using HullKeeper = std::function<bool(std::span<const std::shared_ptr<const recon::Silhouette>>)>;

  // `frames`: all of the session; `stamps`: the session's stamp rows, where a clearance is required; else
  // none: motion doesn't count then. Throws: what `read` throws.
  RecordedMotion(const core::Rig& rig, std::vector<sessions::FrameSummary> frames,
                 std::vector<sessions::StampRow> stamps, FrameReader read, HullKeeper keeper = {});

  // Whether what a frame gives depends on frames before it.
  [[nodiscard]] bool CountsMotion() const { return !stamps_.empty(); }

  // The frame at that position of `frames`. Where motion counts, some frames before are read, too; if the
  // last one loaded was the one before, these are known. The result is the same in any order.
  [[nodiscard]] MotionFrame Load(std::size_t position);

  [[nodiscard]] std::int64_t hulls_made() const { return hulls_made_; }
  [[nodiscard]] std::int64_t hulls_kept() const { return hulls_kept_; }

 private:
  [[nodiscard]] MotionFrame Follow(std::size_t position);

  std::shared_ptr<const core::Rig> rig_;
  std::vector<sessions::FrameSummary> frames_;
  std::vector<sessions::StampRow> stamps_;
  FrameReader read_;
  HullKeeper keeper_;
  recon::UndistortedPlanes planes_;  // none before the first frame
  recon::MotionHistory motions_;
  SharedHull last_;
  std::size_t next_ = 0;  // position
  std::int64_t hulls_made_ = 0, hulls_kept_ = 0;
};

}  // namespace elbowroom::control
