// Cameras that see analytic solids: images as from a real rig, with the ground truth.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "recon/footage/frame_set.h"
#include "recon/synthetic/camera_view.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

struct SyntheticRigOptions {
  std::uint64_t seed = 1;
  core::FrameIndex noise_from = 0;              // the noise of frame i is that of i + this; >= 0
  double frame_rate_hz = 15.0;                  // > 0
  std::optional<core::FrameIndex> frame_count;  // > 0; nothing: no end
  std::string what_ends_it = "the simulation";  // FrameSetSource::WhatEndsIt
  double noise_sigma_levels = 1.5;              // Gaussian, each pixel and channel on its own; >= 0
  double flicker_share = 0.01;  // exposure gain of each camera and frame within 1 +- this; [0, 0.5]
  int background_frames = 30;   // number that a reference is measured from; > 0
  bool table_shadow = false;    // the objects' soft shadow on the table (about ten times slower)
  // Rays of a pixel that may see an object, each way; 1: through its centre alone. More give a pixel on an
  // edge the mixture of what it covers, as a sensor does. [1, 16]
  int samples_per_pixel_side = 1;

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

// What stands in front of the cameras at a time.
using SceneAtTime = std::function<std::vector<SyntheticObject>(double time_s)>;

// Frames are a function of (rig, scene, options, index) alone: any order, any number of threads, same bits.
// With one sample a pixel it is the colour along the ray through its centre, so that a perfect segmentation
// yields TrueMasks (synthetic_rig_test: Segmentation...). Thread: any, as long as the scene function is.
class SyntheticRig : public FrameSetSource {
 public:
  // Undistorts every pixel of every camera once. Throws: PreconditionError for options out of range,
  // Error{kCamera} for a rig without cameras or a lens without a ray for some pixel.
  SyntheticRig(core::Rig rig, SceneAtTime scene_at, SyntheticRigOptions options = {});

  // The same cameras before another scene: what takes long is shared, rays, cloth and the background that one
  // of them measures. The noise of its frames begins at `noise_from`. Throws: PreconditionError.
  [[nodiscard]] SyntheticRig Before(SceneAtTime scene_at, std::optional<core::FrameIndex> frame_count,
                                    core::FrameIndex noise_from) const;

  [[nodiscard]] const core::Rig& rig() const override { return rig_; }
  [[nodiscard]] std::optional<core::FrameIndex> frame_count() const override { return options_.frame_count; }
  [[nodiscard]] std::string WhatEndsIt() const override { return options_.what_ends_it; }
  [[nodiscard]] std::optional<FrameSet> TryRead(core::FrameIndex index, std::stop_token stop) override;
  [[nodiscard]] std::vector<BackgroundReference> ReadBackgrounds(const core::Progress& progress,
                                                                 std::stop_token stop) override;

  [[nodiscard]] double TimeOfFrameS(core::FrameIndex index) const;

  // The truth: what stood there, and the (distorted) pixels whose centre ray hits it, one mask a camera.
  [[nodiscard]] std::vector<SyntheticObject> ObjectsAt(core::FrameIndex index) const;
  [[nodiscard]] std::vector<core::BitMask> TrueMasks(std::span<const SyntheticObject> objects) const;

 private:
  [[nodiscard]] cv::Mat Capture(core::CameraIndex camera, core::FrameIndex noise_frame,
                                std::span<const Solid> solids) const;
  [[nodiscard]] std::vector<BackgroundReference> MeasureBackgrounds(const core::Progress& progress,
                                                                    const std::stop_token& stop) const;

  // What doesn't depend on the scene.
  struct Empty {
    std::vector<CameraView> views;
    std::mutex mutex;
    std::vector<BackgroundReference> backgrounds;  // none: not measured yet
  };

  core::Rig rig_;
  SceneAtTime scene_at_;
  SyntheticRigOptions options_;
  std::shared_ptr<Empty> empty_;
};

}  // namespace elbowroom::recon
