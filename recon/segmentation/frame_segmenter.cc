#include "recon/segmentation/frame_segmenter.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>

#include "core/error.h"
#include "recon/segmentation/mask_regions.h"

namespace elbowroom::recon {
namespace {

// A soft mask less some blobs. Pixels that stay on the boundary were on it before, with the same level.
core::SoftMask WithoutBlobs(const core::SoftMask& soft, const Regions& regions,
                            const std::vector<bool>& keep) {
  core::SoftMask left{soft.mask, {}};
  ClearRegions(left.mask, regions, keep);
  const core::BitMask before = core::BoundaryPixels(soft.mask), after = core::BoundaryPixels(left.mask);
  auto level = soft.levels.begin();
  for (std::size_t i = 0; i < before.words().size() && !soft.levels.empty(); ++i) {
    for (std::uint64_t bits = before.words()[i]; bits != 0; bits &= bits - 1, ++level) {
      if ((after.words()[i] & bits & (~bits + 1)) != 0) left.levels.push_back(*level);
    }
  }
  return left;
}

}  // namespace

FrameSegmenter::FrameSegmenter(const std::vector<BackgroundReference>& backgrounds,
                               const SegmentationOptions& options, const core::Rig& rig)
    : cross_camera_blobs_(rig) {
  options.Validate(rig);
  core::Require(backgrounds.size() == rig.cameras.size(), "one background a camera");
  for (std::size_t i = 0; i < backgrounds.size(); ++i) {
    segmenters_.emplace_back();
    if (backgrounds[i].mean_bgr.empty()) continue;
    const std::string& name = rig.cameras[i].name();
    const CameraSegmentation* differing = options.OfCamera(name);
    segmenters_.back().emplace(backgrounds[i], options.ForCamera(name),
                               differing == nullptr ? core::BitMask() : differing->ignore);
  }
  for (const core::CameraModel& camera : rig.cameras) {
    all_object_.emplace_back(camera.width_px(), camera.height_px());
    all_object_.back().SetAll();
  }
}

std::vector<bool> FrameSegmenter::MissingIn(const FrameSet& frames) {
  const bool has_stamps =
      std::ranges::any_of(frames.cameras, [](const CameraFrame& camera) { return camera.stamp.has_value(); });
  std::vector<bool> is_missing;
  for (const CameraFrame& camera : frames.cameras)
    is_missing.push_back(has_stamps && !camera.stamp && !camera.ready_mask && camera.image_bgr.empty());
  return is_missing;
}

std::vector<core::SoftMask> FrameSegmenter::Masks(const FrameSet& frames, Edges edges,
                                                  SegmentationStats* stats) const {
  core::Require(frames.cameras.size() == segmenters_.size(), "one frame a camera");
  std::vector<core::SoftMask> masks(frames.cameras.size());
  std::vector<SegmentationStats> each(frames.cameras.size());
  const std::vector<bool> is_missing = MissingIn(frames);
  std::atomic<bool> shows_object{false};
  tbb::parallel_for(std::size_t{0}, masks.size(), [&](std::size_t i) {
    const CameraFrame& camera = frames.cameras[i];
    core::Require(camera.ready_mask || is_missing[i] || segmenters_[i],
                  "a picture to segment has a background");
    if (is_missing[i]) {
      masks[i].mask = all_object_[i];
      return;  // it confirms every blob, and has none of its own
    }
    masks[i] = MaskOf(camera, i, edges, BlobLimit::kUsual, &each[i]);
    if (masks[i].mask.ShowsObject()) shows_object.store(true, std::memory_order_relaxed);
  });
  if (shows_object)
    DropUnconfirmed(frames, is_missing, LookAgain(frames, is_missing, edges, &masks, &each.front()), &masks);
  if (stats != nullptr)
    for (const SegmentationStats& of_camera : each) *stats += of_camera;
  return masks;
}

core::SoftMask FrameSegmenter::MaskOf(const CameraFrame& camera, std::size_t i, Edges edges, BlobLimit limit,
                                      SegmentationStats* stats) const {
  if (camera.ready_mask) return {*camera.ready_mask, {}};
  if (edges == Edges::kLocated) return segmenters_[i]->SegmentSoft(camera.image_bgr, stats, limit);
  return {segmenters_[i]->Segment(camera.image_bgr, stats, limit), {}};
}

// A tool that points at a camera is a small blob there. Without that blob the tool would have no hull at all.
std::vector<ConfirmedBlobs> FrameSegmenter::LookAgain(const FrameSet& frames,
                                                      const std::vector<bool>& is_missing, Edges edges,
                                                      std::vector<core::SoftMask>* masks,
                                                      SegmentationStats* stats) const {
  std::vector<const core::BitMask*> bits;
  for (const core::SoftMask& mask : *masks) bits.push_back(&mask.mask);
  std::vector<ConfirmedBlobs> confirmed = cross_camera_blobs_.Confirm(bits);
  const std::vector<bool> may_overlook = cross_camera_blobs_.MayOverlook(bits, confirmed);
  bool is_changed = false;
  for (std::size_t i = 0; i < masks->size(); ++i) {
    if (!may_overlook[i] || is_missing[i] || frames.cameras[i].ready_mask) continue;
    core::SoftMask mask = MaskOf(frames.cameras[i], i, edges, BlobLimit::kSmall, nullptr);
    ++stats->second_looks;
    if (mask == (*masks)[i]) continue;
    (*masks)[i] = std::move(mask);
    is_changed = true;
  }
  return is_changed ? cross_camera_blobs_.Confirm(bits) : confirmed;
}

// Runs after the boundaries are located, since that may move them outwards: a dropped blob must have no point
// in the hull of the masks that are handed on.
void FrameSegmenter::DropUnconfirmed(const FrameSet& frames, const std::vector<bool>& is_missing,
                                     const std::vector<ConfirmedBlobs>& confirmed,
                                     std::vector<core::SoftMask>* masks) {
  for (std::size_t i = 0; i < masks->size(); ++i) {
    const std::vector<bool>& keep = confirmed[i].is_confirmed;
    if (is_missing[i] || frames.cameras[i].ready_mask || std::ranges::find(keep, false) == keep.end())
      continue;
    (*masks)[i] = WithoutBlobs((*masks)[i], confirmed[i].blobs, keep);
  }
}

std::vector<core::BitMask> FrameSegmenter::Segment(const FrameSet& frames) const {
  std::vector<core::BitMask> masks;
  for (core::SoftMask& mask : Masks(frames, Edges::kDetected, nullptr)) masks.push_back(std::move(mask.mask));
  return masks;
}

std::vector<core::SoftMask> FrameSegmenter::SegmentSoft(const FrameSet& frames,
                                                        SegmentationStats* stats) const {
  return Masks(frames, Edges::kLocated, stats);
}

}  // namespace elbowroom::recon
