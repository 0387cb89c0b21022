#include "recon/capture/v4l2/video_system.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <cerrno>
#include <utility>

#include "core/system/child_process.h"

namespace elbowroom::recon {
namespace {

class KernelVideo : public VideoSystem {
 public:
  explicit KernelVideo(core::Descriptor device) : device_(std::move(device)) {}

  int Ioctl(unsigned long request, void* argument) override {
    int result = 0;
    do {
      result = ::ioctl(device_.number(), request, argument);
    } while (result < 0 && errno == EINTR);
    return result;
  }
  void* Map(std::size_t length, std::int64_t offset) override {
    return ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, device_.number(), offset);
  }
  void Unmap(void* memory, std::size_t length) override { ::munmap(memory, length); }
  int Wait(std::chrono::milliseconds most_wait) override {
    pollfd waiting{device_.number(), POLLIN, 0};
    return ::poll(&waiting, 1, static_cast<int>(most_wait.count()));
  }

 private:
  core::Descriptor device_;
};

}  // namespace

std::unique_ptr<VideoSystem> OpenVideoSystem(const std::string& path) {
  core::Descriptor device(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (!device.is_open()) return nullptr;
  return std::make_unique<KernelVideo>(std::move(device));
}

}  // namespace elbowroom::recon
