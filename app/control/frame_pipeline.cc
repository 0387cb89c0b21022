#include "app/control/frame_pipeline.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {
namespace {

class Stopwatch {
 public:
  // Since the last lap or the start.
  double LapMs() {
    const auto now = std::chrono::steady_clock::now();
    const double lap_ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return lap_ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// One a camera, with nothing for one whose picture is missing. Empty: no camera has a stamp.
std::vector<std::optional<core::CameraStamp>> StampsOf(const recon::FrameSet& frames) {
  const auto has_stamp = [](const recon::CameraFrame& camera) { return camera.stamp.has_value(); };
  if (std::ranges::none_of(frames.cameras, has_stamp)) return {};
  std::vector<std::optional<core::CameraStamp>> stamps;
  for (const recon::CameraFrame& camera : frames.cameras) stamps.push_back(camera.stamp);
  return stamps;
}

}  // namespace

FramePipeline::FramePipeline(core::Rig rig, core::Layout layout,
                             const std::vector<recon::BackgroundReference>& backgrounds,
                             const recon::SegmentationOptions& segmentation,
                             const review::PartReviewOptions& review)
    : rig_(std::make_shared<const core::Rig>(std::move(rig))),
      planes_(recon::MakeUndistortedPlanes(*rig_)),
      layout_(std::make_shared<const core::Layout>(std::move(layout))),
      judge_(*layout_, review),
      responders_(*layout_),
      segmenter_(backgrounds, segmentation, *rig_),
      asks_clearance_(review.required_clearance_mm > 0.0) {
  rig_->Validate();
  core::Require(backgrounds.size() == rig_->cameras.size(), "one background reference a camera");
}

SharedFrameResult FramePipeline::Process(recon::FrameSet frames, std::span<const double> spacing_mm,
                                         const WithHull& beside) {
  core::Require(frames.cameras.size() == rig_->cameras.size(), "one frame a camera");
  const std::shared_ptr<FrameResult> result = results_.Take();
  result->record.frame = frames.index;
  result->record.time_s = frames.time_s;
  result->record.stamps = StampsOf(frames);
  result->record.losses = frames.losses;
  result->layout = layout_;
  result->record.spacing_mm.assign(spacing_mm.begin(), spacing_mm.end());
  const std::vector<core::RigidTransform> world_from_rests = core::PosesAt(*layout_, spacing_mm);
  if (last_ && last_->response) result->record.rest_from_parts = MotionsOf(*last_->response);
  result->world_from_parts = core::WithMotions(world_from_rests, result->record.rest_from_parts);
  Stopwatch watch;
  std::vector<core::SoftMask> masks = segmenter_.SegmentSoft(frames, &result->skipped.segmentation);
  result->times.segmentation_ms = watch.LapMs();
  UpdateHull(std::move(masks), result.get());
  result->times.hull_ms = watch.LapMs();
  if (beside) {
    tbb::parallel_invoke([&] { Judge(world_from_rests, result.get()); }, [&] { beside(result->hull); });
  } else {
    Judge(world_from_rests, result.get());
  }
  result->camera_frames = std::make_shared<const recon::FrameSet>(std::move(frames));
  last_ = result;
  return result;
}

void FramePipeline::Judge(std::span<const core::RigidTransform> world_from_rests, FrameResult* result) {
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

void FramePipeline::UpdateHull(std::vector<core::SoftMask> masks, FrameResult* result) {
  recon::FrameHull next = recon::NextHull(last_ ? last_->hull : nullptr, rig_, planes_, masks);
  result->hull = std::move(next.hull);
  result->skipped.hull = next.stats;
  const bool is_unchanged = last_ && result->hull == last_->hull;
  result->record.masks = is_unchanged ? last_->record.masks
                                      : std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
}

void FramePipeline::UpdateResponse(std::span<const core::RigidTransform> world_from_rests,
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
