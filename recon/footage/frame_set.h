// What the cameras of a rig saw at one instant, and where such sets come from.
#pragma once

#include <chrono>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/bit_mask.h"
#include "core/camera_model.h"
#include "core/ids.h"
#include "core/progress.h"
#include "core/rig.h"
#include "core/session.h"

namespace elbowroom::recon {

struct CameraFrame {
  cv::Mat image_bgr;  // 8-bit, 3 channels; empty where the camera brings ready masks
  std::optional<core::BitMask> ready_mask = std::nullopt;  // then there is nothing to segment
  // Of a picture that has one: of a live camera, or of footage that was recorded with stamps.
  std::optional<core::CameraStamp> stamp = std::nullopt;
};

// What a camera outside of the rig saw (recon/footage/viewer_footage.h).
struct ViewerPicture {
  std::shared_ptr<const core::CameraModel> camera;
  cv::Mat image_bgr;  // 8-bit, 3 channels, of the camera's size
};

struct FrameSet {
  core::FrameIndex index = 0;
  double time_s = 0.0;                         // of capture, from frame 0
  std::vector<CameraFrame> cameras;            // in the rig's order
  std::vector<core::PictureLoss> losses = {};  // of live cameras, that became known since the set before
  // The instant of time_s on the computer's clock; nothing for recorded footage.
  std::optional<std::chrono::steady_clock::time_point> taken_at = std::nullopt;
  std::optional<ViewerPicture> viewer = std::nullopt;
};

// The empty scene as one camera sees it: mean and noise of every pixel and channel.
struct BackgroundReference {
  cv::Mat mean_bgr;   // CV_32FC3, grey levels; empty for a camera with ready masks
  cv::Mat sigma_bgr;  // CV_32FC3, standard deviation over the background's frames, grey levels
  int frames = 0;     // that it was measured from; with one frame sigma is zero everywhere
};

// Recorded footage, a simulation, a replay: anything that yields frame sets in order.
// Thread: one reader.
class FrameSetSource {
 public:
  virtual ~FrameSetSource() = default;
  [[nodiscard]] virtual const core::Rig& rig() const = 0;

  // The number of frames of the shortest source, as promised by the files until TryRead has met the end;
  // nothing if no source has an end.
  [[nodiscard]] virtual std::optional<core::FrameIndex> frame_count() const = 0;

  // What the end depends on: "the shortest source, camera 'cam03' (426 frames)"; "" without an end.
  [[nodiscard]] virtual std::string WhatEndsIt() const = 0;

  // Nothing at and after the end. Throws: Error{kRange} for an index below 0, Error{kFile} naming camera,
  // file and frame if it can't be read whole, Error{kCamera} when a live camera ended; Error{kCancelled} on a
  // stop, heard at once.
  [[nodiscard]] virtual std::optional<FrameSet> TryRead(core::FrameIndex index, std::stop_token stop) = 0;

  // The same, for a frame that must exist. Throws: what TryRead throws; Error{kRange} past the end.
  [[nodiscard]] FrameSet Read(core::FrameIndex index, std::stop_token stop = {});

  // Problems of the frames read so far that didn't keep them from being read, a line each.
  [[nodiscard]] virtual std::vector<std::string> Warnings() const { return {}; }

  // Of each live camera, why nothing comes from it at present, one line; "": it is there. Empty: no camera is
  // live. Thread: any.
  [[nodiscard]] virtual std::vector<std::string> CameraTroubles() const { return {}; }

  // One a camera. Throws: Error{kFile}; Error{kCancelled} on a stop.
  [[nodiscard]] virtual std::vector<BackgroundReference> ReadBackgrounds(const core::Progress& progress,
                                                                         std::stop_token stop) = 0;
};

}  // namespace elbowroom::recon
