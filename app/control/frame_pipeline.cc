#include "app/control/frame_pipeline.h"

#include <algorithm>
#include <utility>

#include "app/control/stopwatch.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

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
    : silhouettes_(std::move(rig), std::move(layout), review),
      segmenter_(backgrounds, segmentation, *silhouettes_.rig()) {
  core::Require(backgrounds.size() == silhouettes_.rig()->cameras.size(),
                "one background reference a camera");
}

std::shared_ptr<FrameResult> FramePipeline::Process(recon::FrameSet frames,
                                                    std::span<const double> spacing_mm,
                                                    const WithHull& beside) {
  core::Require(frames.cameras.size() == silhouettes_.rig()->cameras.size(), "one frame a camera");
  recon::SegmentationStats stats;
  Stopwatch watch;
  SilhouetteFrame seen{frames.index, frames.time_s, segmenter_.SegmentSoft(frames, &stats), StampsOf(frames),
                       frames.losses};
  const double segmentation_ms = watch.LapMs();
  const std::shared_ptr<FrameResult> result = silhouettes_.Process(std::move(seen), spacing_mm, beside);
  result->skipped.segmentation = stats;
  result->times.segmentation_ms = segmentation_ms;
  result->camera_frames = std::make_shared<const recon::FrameSet>(std::move(frames));
  return result;
}

}  // namespace elbowroom::control
