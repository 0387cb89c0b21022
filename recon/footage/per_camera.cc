#include "recon/footage/per_camera.h"

#include <exception>
#include <thread>
#include <vector>

namespace elbowroom::recon {

void RunPerCamera(std::size_t cameras, const std::function<void(core::CameraIndex)>& work,
                  const std::function<void()>& meanwhile) {
  std::vector<std::exception_ptr> errors(cameras);
  {
    std::vector<std::jthread> threads;  // joined at the end of this block, however it is left
    for (core::CameraIndex i = 0; i < cameras; ++i) {
      threads.emplace_back([&, i] {
        try {
          work(i);
        } catch (...) {
          errors[i] = std::current_exception();
        }
      });
    }
    meanwhile();
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace elbowroom::recon
