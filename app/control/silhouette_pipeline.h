// Silhouettes in, contacts out: what follows the segmentation in a trial, and all of a replay.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/control/frame_judge.h"
#include "app/control/frame_result.h"
#include "app/control/frame_result_pool.h"
#include "app/control/part_reactions.h"
#include "core/bvh.h"
#include "core/layout.h"
#include "core/rig.h"
#include "core/session.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/error_budget/motion_history.h"
#include "review/part_review.h"

namespace elbowroom::control {

// Called with the frame's hull.
using WithHull = std::function<void(const SharedHull&)>;

// A frame's silhouettes, and what belongs to their pictures.
struct SilhouetteFrame {
  core::FrameIndex frame = 0;
  double time_s = 0.0;
  std::vector<core::SoftMask> masks;                     // one a camera
  std::vector<std::optional<core::CameraStamp>> stamps;  // as in FrameRecord
  std::vector<core::PictureLoss> losses;
};

// Keeps what needn't be computed again for the next frame: silhouettes that didn't change, and parts that
// didn't move while the hull didn't change. Skipping never changes a result, with one exception: the search
// for a clearance begins at the last frame's witness points, so that its bounds, certain all the same, may
// differ within the tolerance (frame_pipeline_test). Thread: one frame at a time.
class SilhouettePipeline {
 public:
  // Throws: what Rig::Validate, Layout::Validate and PartReviewOptions::Validate throw.
  SilhouettePipeline(core::Rig rig, core::Layout layout, const review::PartReviewOptions& review);

  [[nodiscard]] const std::shared_ptr<const core::Rig>& rig() const { return rig_; }
  [[nodiscard]] const std::shared_ptr<const core::Layout>& layout() const { return layout_; }
  [[nodiscard]] std::span<const core::TriangleTree> part_trees() const { return judge_.part_trees(); }

  // spacing_mm: in the layout's order. The parts are judged before they give way in this frame, and cloths in
  // their shape at rest; then those that give way react to the hull, over the time since the last frame.
  // `beside`: work that needs only the hull; it runs on any thread while the parts are judged, and Process
  // waits for it. The caller may fill in what is known of the pictures.
  [[nodiscard]] std::shared_ptr<FrameResult> Process(SilhouetteFrame frame,
                                                     std::span<const double> spacing_mm,
                                                     const WithHull& beside = {});

 private:
  void UpdateHull(std::vector<core::SoftMask> masks, FrameResult* result);
  void Judge(std::span<const core::RigidTransform> world_from_rests, FrameResult* result);
  void UpdateResponse(std::span<const core::RigidTransform> world_from_rests, FrameResult* result);

  std::shared_ptr<const core::Rig> rig_;
  recon::UndistortedPlanes planes_;
  std::shared_ptr<const core::Layout> layout_;
  const core::SpacingPoses poses_;
  FrameResultPool results_;
  FrameJudge judge_;
  PartReactions responders_;
  bool asks_clearance_;
  recon::MotionHistory motions_;
  SharedFrameResult last_;
};

}  // namespace elbowroom::control
