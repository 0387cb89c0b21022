#include "recon/capture/shared_slots.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/error.h"
#include "recon/capture/device/camera_protocol.h"

namespace elbowroom::recon {

SharedSlots::SharedSlots(cv::Size size_px)
    : bytes_(std::size_t{3} * static_cast<std::size_t>(size_px.area())),
      size_px_(size_px),
      file_(core::MakeMemoryFile("camera")) {
  const auto all = static_cast<off_t>(bytes_ * kPictureSlots);
  const bool has_memory = ::ftruncate(file_.number(), all) == 0 &&
                          ::fcntl(file_.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) == 0;
  void* memory = has_memory ? ::mmap(nullptr, static_cast<std::size_t>(all), PROT_READ | PROT_WRITE,
                                     MAP_SHARED, file_.number(), 0)
                            : MAP_FAILED;
  if (memory == MAP_FAILED) {
    throw core::Error(core::ErrorKind::kFile, "there is no memory for pictures; close other programs");
  }
  memory_ = static_cast<unsigned char*>(memory);
}

SharedSlots::~SharedSlots() { ::munmap(memory_, bytes_ * kPictureSlots); }

cv::Mat SharedSlots::Slot(std::int32_t slot) const {
  core::Require(slot >= 0 && slot < kPictureSlots, "a slot is one of those that there are");
  return {size_px_, CV_8UC3, memory_ + static_cast<std::size_t>(slot) * bytes_};
}

}  // namespace elbowroom::recon
