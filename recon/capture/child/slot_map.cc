#include "recon/capture/child/slot_map.h"

#include <sys/mman.h>

#include <cstddef>

#include "recon/capture/device/camera_protocol.h"

namespace elbowroom::recon {

std::vector<cv::Mat> MapSlots(cv::Size size_px) {
  const std::size_t picture_bytes = std::size_t{3} * static_cast<std::size_t>(size_px.area());
  void* memory =
      ::mmap(nullptr, picture_bytes * kPictureSlots, PROT_READ | PROT_WRITE, MAP_SHARED, kCameraMemory, 0);
  std::vector<cv::Mat> slots;
  if (memory == MAP_FAILED) return slots;
  for (std::size_t i = 0; i < kPictureSlots; ++i)
    slots.emplace_back(size_px, CV_8UC3, static_cast<unsigned char*>(memory) + i * picture_bytes);
  return slots;
}

}  // namespace elbowroom::recon
