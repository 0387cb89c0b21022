// Camera frames in, contacts out: one frame's way through recon and review.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "app/control/frame_judge.h"
#include "app/control/frame_result.h"
#include "app/control/frame_result_pool.h"
#include "app/control/part_reactions.h"
#include "core/bvh.h"
#include "core/layout.h"
#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/error_budget/motion_history.h"
#include "recon/footage/frame_set.h"
#include "recon/segmentation/frame_segmenter.h"
#include "review/part_review.h"

namespace elbowroom::control {

// Keeps what needn't be computed again for the next frame: silhouettes that didn't change, and parts that
// didn't move while the hull didn't change. Skipping never changes a result, with one exception: the search
// for a clearance begins at the last frame's witness points, so that its bounds, certain all the same, may
// differ within the tolerance (frame_pipeline_test). Thread: one frame at a time.
class FramePipeline {
 public:
  // Called with the frame's hull.
  using WithHull = std::function<void(const SharedHull&)>;

  // Throws: what Rig::Validate, Layout::Validate and PartReviewOptions::Validate throw.
  FramePipeline(core::Rig rig, core::Layout layout,
                const std::vector<recon::BackgroundReference>& backgrounds,
                const recon::SegmentationOptions& segmentation, const review::PartReviewOptions& review = {});

  [[nodiscard]] const std::shared_ptr<const core::Rig>& rig() const { return rig_; }
  [[nodiscard]] const std::shared_ptr<const core::Layout>& layout() const { return layout_; }
  [[nodiscard]] std::span<const core::TriangleTree> part_trees() const { return judge_.part_trees(); }

  // spacing_mm: in the layout's order. The result shares the frames' pictures. The parts are judged before
  // they give way in this frame, and cloths in their shape at rest; then those that give way react to the
  // hull, over the time since the last frame. `beside`: work that needs only the hull; it runs on any thread
  // while the parts are judged, and Process waits for it.
  [[nodiscard]] SharedFrameResult Process(recon::FrameSet frames, std::span<const double> spacing_mm,
                                          const WithHull& beside = {});

 private:
  void UpdateHull(std::vector<core::SoftMask> masks, FrameResult* result);
  void Judge(std::span<const core::RigidTransform> world_from_rests, FrameResult* result);
  void UpdateResponse(std::span<const core::RigidTransform> world_from_rests, FrameResult* result);

  std::shared_ptr<const core::Rig> rig_;
  recon::UndistortedPlanes planes_;
  std::shared_ptr<const core::Layout> layout_;
  FrameResultPool results_;
  FrameJudge judge_;
  PartReactions responders_;
  recon::FrameSegmenter segmenter_;
  bool asks_clearance_;
  recon::MotionHistory motions_;
  SharedFrameResult last_;
};

}  // namespace elbowroom::control
