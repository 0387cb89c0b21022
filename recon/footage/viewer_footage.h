// A camera worn on the head, or standing near the operator: its pictures colour the hull and carve nothing.
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "recon/footage/frame_set.h"
#include "recon/footage/image_source.h"
#include "recon/footage/read_ahead.h"
#include "recon/footage/recorded_rig.h"

namespace elbowroom::recon {

// The rig's frame sets, each with the viewer camera's picture of the same number. If its footage ends before
// the rig's, the sets after its end have none. Thread: one reader.
class ViewerFootage : public FrameSetSource {
 public:
  // `location`: a resolved one (recon/rig_files/source_location.h). Throws: core::Error as OpenImageSource;
  // Error{kFormat} naming the camera when its frame rate isn't the rig's.
  ViewerFootage(std::shared_ptr<RecordedRig> rig, core::CameraModel camera, const std::string& location,
                std::stop_token stop = {});

  [[nodiscard]] const core::Rig& rig() const override { return rig_->rig(); }
  [[nodiscard]] std::optional<core::FrameIndex> frame_count() const override { return rig_->frame_count(); }
  // The number of the viewer camera's frames, as promised until its end has been met.
  [[nodiscard]] core::FrameIndex viewer_frame_count() const { return source_->frame_count(); }
  [[nodiscard]] std::string WhatEndsIt() const override { return rig_->WhatEndsIt(); }

  [[nodiscard]] std::optional<FrameSet> TryRead(core::FrameIndex index, std::stop_token stop) override;
  [[nodiscard]] std::vector<std::string> Warnings() const override;
  [[nodiscard]] std::vector<BackgroundReference> ReadBackgrounds(const core::Progress& progress,
                                                                 std::stop_token stop) override;

 private:
  std::shared_ptr<RecordedRig> rig_;
  std::shared_ptr<const core::CameraModel> camera_;
  std::string location_;
  std::shared_ptr<const ImageSource> source_;
  core::FrameIndex promised_ = 0;
  std::optional<core::FrameIndex> end_;  // of the viewer camera's footage, once met
  std::unique_ptr<ReadAhead> pictures_;
};

}  // namespace elbowroom::recon
