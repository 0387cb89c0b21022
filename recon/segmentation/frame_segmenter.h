// A frame set's masks: ready ones as they are, others by segmenting the pictures, and all object where a
// picture is missing.
#pragma once

#include <optional>
#include <vector>

#include "core/bit_mask.h"
#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/footage/frame_set.h"
#include "recon/segmentation/cross_camera_blobs.h"
#include "recon/segmentation/segmentation.h"

namespace elbowroom::recon {

// One segmenter a camera that has a background, and the rig, whose cameras confirm each other: blobs that
// can't be part of the hull are dropped from segmented pictures (CrossCameraBlobs). Immutable. Thread: any.
class FrameSegmenter {
 public:
  // Throws: core::Error{kRange} as SegmentationOptions::Validate(rig); core::Error as core::Rig::Validate();
  // PreconditionError unless there is one background a camera.
  FrameSegmenter(const std::vector<BackgroundReference>& backgrounds, const SegmentationOptions& options,
                 const core::Rig& rig);

  // One mask a camera: the pixels detected, with boundaries where the thresholds put them. Cameras are
  // processed in parallel. Of a camera without picture, ready mask and stamp, in a set in which another
  // camera has a stamp, all pixels are object: its picture is missing, so it can't exclude anything. Throws:
  // PreconditionError for a picture whose camera has no background.
  [[nodiscard]] std::vector<core::BitMask> Segment(const FrameSet& frames) const;

  // The same with boundaries located between pixels; ready masks come without levels. `stats` grows by the
  // counts of all pictures. Throws: likewise.
  [[nodiscard]] std::vector<core::SoftMask> SegmentSoft(const FrameSet& frames,
                                                        SegmentationStats* stats = nullptr) const;

 private:
  enum class Edges { kDetected, kLocated };
  [[nodiscard]] std::vector<core::SoftMask> Masks(const FrameSet& frames, Edges edges,
                                                  SegmentationStats* stats) const;
  [[nodiscard]] static std::vector<bool> MissingIn(const FrameSet& frames);
  [[nodiscard]] core::SoftMask MaskOf(const CameraFrame& camera, std::size_t i, Edges edges, BlobLimit limit,
                                      SegmentationStats* stats) const;
  // The blobs of the masks after cameras were looked at again whose blob may have been too small.
  [[nodiscard]] std::vector<ConfirmedBlobs> LookAgain(const FrameSet& frames,
                                                      const std::vector<bool>& is_missing, Edges edges,
                                                      std::vector<core::SoftMask>* masks,
                                                      SegmentationStats* stats) const;
  static void DropUnconfirmed(const FrameSet& frames, const std::vector<bool>& is_missing,
                              const std::vector<ConfirmedBlobs>& confirmed,
                              std::vector<core::SoftMask>* masks);

  std::vector<std::optional<Segmenter>> segmenters_;
  std::vector<core::BitMask> all_object_;  // one a camera
  CrossCameraBlobs cross_camera_blobs_;
};

}  // namespace elbowroom::recon
