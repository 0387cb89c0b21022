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

}  // namespace

FramePipeline::FramePipeline(core::Rig rig, core::Layout layout,
                             const std::vector<recon::BackgroundReference>& backgrounds,
                             const recon::SegmentationOptions& segmentation,
                             const review::PartReviewOptions& review)
    : rig_(std::make_shared<const core::Rig>(std::move(rig))),
      planes_(recon::MakeUndistortedPlanes(*rig_)),
      layout_(std::make_shared<const core::Layout>(std::move(layout))),
      responders_(*layout_),
      segmenter_(backgrounds, segmentation, *rig_),
      review_(review) {
  rig_->Validate();
  layout_->Validate();
  review_.Validate();
  core::Require(backgrounds.size() == rig_->cameras.size(), "one background reference a camera");
  for (const core::Part& part : layout_->parts) part_trees_.emplace_back(part.mesh);
  for (const core::TriangleTree& part : part_trees_) inside_parts_.emplace_back(part);
}

SharedFrameResult FramePipeline::Process(recon::FrameSet frames, std::span<const double> spacing_mm,
                                         const WithHull& beside) {
  core::Require(frames.cameras.size() == rig_->cameras.size(), "one frame a camera");
  auto result = std::make_shared<FrameResult>();
  result->record.frame = frames.index;
  result->record.time_s = frames.time_s;
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
  UpdateContacts(result);
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
  // The time step of the first frame, and the longest time step, which bounds that after a pause.
  constexpr double kFirstS = 1.0 / 30.0, kLongestS = 0.25;
  const double since_s = last_ ? result->record.time_s - last_->record.time_s : kFirstS;
  const SharedReactions last = last_ ? last_->response : nullptr;
  result->response = since_s > 0.0 ? responders_.Step(last, world_from_rests, result->record.contacts,
                                                      result->hull, std::min(since_s, kLongestS))
                                   : last;
}

void FramePipeline::UpdateContacts(FrameResult* result) {
  const std::size_t parts = part_trees_.size();
  result->record.contacts.resize(parts);
  std::vector<std::uint8_t> is_unchanged(parts, 0);
  for (std::size_t i = 0; i < parts; ++i)
    is_unchanged[i] =
        last_ && last_->hull == result->hull && last_->world_from_parts[i] == result->world_from_parts[i];
  if (std::ranges::count(is_unchanged, 0) > 0) result->hull->Prepare();
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t i) {
    result->record.contacts[i] = is_unchanged[i] ? last_->record.contacts[i] : Review(*result, i);
  });
  for (std::size_t i = 0; i < parts; ++i) {
    if (is_unchanged[i]) {
      ++result->skipped.unchanged_parts;
      continue;
    }
    result->skipped.triangles_in_all += result->record.contacts[i].count.triangles;
    result->skipped.triangles_skipped += result->record.contacts[i].count.skipped;
    result->skipped.queries += result->record.contacts[i].count.queries;
    if (!result->record.contacts[i].clearance) continue;
    const core::PartClearance& clearance = *result->record.contacts[i].clearance;
    result->skipped.clearance_queries += clearance.queries;
    if (result->record.contacts[i].contact_point_count > 0 ||
        result->record.contacts[i].contained_in_world_mm) {
      ++result->skipped.clearances_by_contact;
    } else if (clearance.queries == 1) {
      ++result->skipped.clearances_by_ball;
    }
  }
}

core::PartContact FramePipeline::Review(const FrameResult& result, core::PartIndex part) {
  const auto hint = last_ ? review::HintFrom(last_->record.contacts[part], last_->world_from_parts[part])
                          : std::optional<review::ClearanceHint>();
  review::PartReviewOptions options = review_;
  options.contacts.recovery = layout_->parts[part].recovery;
  return review::ReviewPart(*result.hull, part_trees_[part], result.world_from_parts[part], part, options,
                            hint, &inside_parts_[part]);
}

}  // namespace elbowroom::control
