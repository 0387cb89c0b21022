#include "app/control/silhouette_pipeline.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <utility>

#include "app/control/stopwatch.h"
#include "core/error.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {

SilhouettePipeline::SilhouettePipeline(core::Rig rig, core::Layout layout,
                                       const review::PartReviewOptions& review)
    : rig_(std::make_shared<const core::Rig>(std::move(rig))),
      planes_(recon::MakeUndistortedPlanes(*rig_)),
      layout_(std::make_shared<const core::Layout>(std::move(layout))),
      poses_(*layout_),
      judge_(*layout_, review),
      responders_(*layout_),
      asks_clearance_(review.required_clearance_mm > 0.0) {
  rig_->Validate();
}

std::shared_ptr<FrameResult> SilhouettePipeline::Process(SilhouetteFrame frame,
                                                         std::span<const double> spacing_mm,
                                                         const WithHull& beside) {
  core::Require(frame.masks.size() == rig_->cameras.size(), "one silhouette a camera");
  std::shared_ptr<FrameResult> result = results_.Take();
  result->record.frame = frame.frame;
  result->record.time_s = frame.time_s;
  result->record.stamps = std::move(frame.stamps);
  result->record.losses = std::move(frame.losses);
  result->layout = layout_;
  result->record.spacing_mm.assign(spacing_mm.begin(), spacing_mm.end());
  const std::vector<core::RigidTransform> world_from_rests = poses_.At(spacing_mm);
  if (last_ && last_->response) result->record.rest_from_parts = MotionsOf(*last_->response);
  result->world_from_parts = core::WithMotions(world_from_rests, result->record.rest_from_parts);
  Stopwatch watch;
  UpdateHull(std::move(frame.masks), result.get());
  result->times.hull_ms = watch.LapMs();
  if (beside) {
    tbb::parallel_invoke([&] { Judge(world_from_rests, result.get()); }, [&] { beside(result->hull); });
  } else {
    Judge(world_from_rests, result.get());
  }
  last_ = result;
  return result;
}

void SilhouettePipeline::Judge(std::span<const core::RigidTransform> world_from_rests, FrameResult* result) {
  Stopwatch watch;
  const bool is_new = !last_ || last_->hull != result->hull;
  if (is_new && !part_trees().empty()) result->hull->Prepare();
  if (asks_clearance_)
    result->skew_errors = motions_.Next(*result->hull, result->record.stamps, result->record.time_s);
  judge_.Judge(last_.get(), result);
  result->times.contacts_ms = watch.LapMs();
  UpdateResponse(world_from_rests, result);
  result->times.response_ms = watch.LapMs();
}

void SilhouettePipeline::UpdateHull(std::vector<core::SoftMask> masks, FrameResult* result) {
  recon::FrameHull next = recon::NextHull(last_ ? last_->hull : nullptr, rig_, planes_, masks);
  result->hull = std::move(next.hull);
  result->skipped.hull = next.stats;
  const bool is_unchanged = last_ && result->hull == last_->hull;
  result->record.masks = is_unchanged ? last_->record.masks
                                      : std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
}

void SilhouettePipeline::UpdateResponse(std::span<const core::RigidTransform> world_from_rests,
                                        FrameResult* result) {
  if (responders_.is_empty()) return;
  // A hull that is too large must not push parts: they wait for the next frame with all cameras.
  if (result->record.LacksCamera()) {
    if (last_) result->response = last_->response;
    return;
  }
  // The time step of the first frame, and the longest time step, which bounds that after a pause.
  constexpr double kFirstS = 1.0 / 30.0, kLongestS = 0.25;
  const double since_s = last_ ? result->record.time_s - last_->record.time_s : kFirstS;
  const SharedReactions last = last_ ? last_->response : nullptr;
  result->response = since_s > 0.0 ? responders_.Step(last, world_from_rests, result->record.contacts,
                                                      result->hull, std::min(since_s, kLongestS))
                                   : last;
}

}  // namespace elbowroom::control
