// Memory for pictures that this program and a child of it share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "core/system/shared_memory.h"

namespace elbowroom::recon {

// kPictureSlots pictures (recon/capture/device/camera_protocol.h), one after the other. Which program may
// write to a slot is agreed by messages. Thread: one at a time.
class SharedSlots {
 public:
  // Throws: Error{kFile} when there is no memory.
  explicit SharedSlots(cv::Size size_px);

  [[nodiscard]] const core::Descriptor& file() const { return memory_.file(); }

  // The pixels of one slot, CV_8UC3, in the shared memory itself.
  [[nodiscard]] cv::Mat Slot(std::int32_t slot) const;

 private:
  std::size_t bytes_;
  cv::Size size_px_;
  core::SharedMemory memory_;
};

}  // namespace elbowroom::recon
