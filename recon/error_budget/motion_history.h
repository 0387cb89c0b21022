// The contours of the cameras' last pictures, from frame to frame.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/session.h"
#include "recon/error_budget/skew_errors.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

class Silhouette;

// Thread: one frame at a time.
class MotionHistory {
 public:
  // The errors of a frame that are due to its cameras' instants; frames come in order. Null: the frame has no
  // stamps. `time_s`: the frame's, on the stamps' clock. A camera that gives the same picture again keeps the
  // motion that it had. Throws: PreconditionError unless there is a stamp, or nothing, for each camera.
  [[nodiscard]] std::shared_ptr<const SkewErrors> Next(
      const VisualHull& hull, std::span<const std::optional<core::CameraStamp>> stamps, double time_s);

 private:
  struct Last {
    std::shared_ptr<const Silhouette> silhouette;  // null: no picture yet
    double time_s = 0.0;
    CameraLook look;  // but for its skew
  };
  static void Follow(const std::shared_ptr<const Silhouette>& silhouette, double time_s, Last* last);

  std::vector<Last> cameras_;
};

}  // namespace elbowroom::recon
