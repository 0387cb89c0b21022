// The calls by which Linux gives a video device: as they are, or as a test plays them.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

namespace elbowroom::recon {

// An open video device. Calls return what the kernel's do, with errno set.
class VideoSystem {
 public:
  virtual ~VideoSystem() = default;
  virtual int Ioctl(unsigned long request, void* argument) = 0;
  // MAP_FAILED if it can't be mapped.
  virtual void* Map(std::size_t length, std::int64_t offset) = 0;
  virtual void Unmap(void* memory, std::size_t length) = 0;
  // As poll for POLLIN: > 0 ready or gone, 0 too late, < 0 failed.
  virtual int Wait(std::chrono::milliseconds most_wait) = 0;
};

// Null, with errno set, if it can't be opened.
[[nodiscard]] std::unique_ptr<VideoSystem> OpenVideoSystem(const std::string& path);

}  // namespace elbowroom::recon
