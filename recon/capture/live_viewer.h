// A live camera worn on the head, or standing near the operator: its pictures colour the hull and carve
// nothing.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "recon/capture/camera_link.h"
#include "recon/footage/frame_set.h"

namespace elbowroom::recon {

// A live rig's frame sets, each with the viewer camera's latest picture; none while that camera is gone.
// Thread: one reader.
class LiveViewer : public FrameSetSource {
 public:
  // `location`: of a live camera.
  LiveViewer(std::shared_ptr<FrameSetSource> rig, core::CameraModel camera, const std::string& location);

  [[nodiscard]] const core::Rig& rig() const override { return rig_->rig(); }
  [[nodiscard]] std::optional<core::FrameIndex> frame_count() const override { return rig_->frame_count(); }
  [[nodiscard]] std::string WhatEndsIt() const override { return rig_->WhatEndsIt(); }
  [[nodiscard]] std::optional<FrameSet> TryRead(core::FrameIndex index, std::stop_token stop) override;
  [[nodiscard]] std::vector<std::string> Warnings() const override;
  [[nodiscard]] std::vector<std::string> CameraTroubles() const override { return rig_->CameraTroubles(); }
  [[nodiscard]] std::vector<BackgroundReference> ReadBackgrounds(const core::Progress& progress,
                                                                 std::stop_token stop) override;

 private:
  std::shared_ptr<FrameSetSource> rig_;
  std::shared_ptr<const core::CameraModel> camera_;
  mutable std::mutex mutex_;
  std::optional<CapturedPicture> latest_;
  CameraState state_;
  std::unique_ptr<CameraLink> link_;  // last: its thread uses the others
};

}  // namespace elbowroom::recon
