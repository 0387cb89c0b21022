#include "tests/openxr_runtime/mock_headset.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <new>
#include <stdexcept>

#include "tests/support/text_file.h"

namespace elbowroom::test_support {

MockHeadset::MockHeadset() {
  const std::string file = (folder_ / "control").string(), json = (folder_ / "runtime.json").string();
  const int number = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (number < 0 || ::ftruncate(number, sizeof(MockControl)) != 0)
    throw std::runtime_error("no control file");
  void* memory = ::mmap(nullptr, sizeof(MockControl), PROT_READ | PROT_WRITE, MAP_SHARED, number, 0);
  ::close(number);
  if (memory == MAP_FAILED) throw std::runtime_error("no control memory");
  control_ = new (memory) MockControl;
  WriteText(json, R"({"file_format_version": "1.0.0", "runtime": {"name": "mock", "library_path": ")" +
                      std::string(ELBOWROOM_MOCK_OPENXR_LIBRARY) + "\"}}\n");
  environment_ = {{"XR_RUNTIME_JSON", json}, {kMockControlVariable, file}};
  for (const auto& [name, value] : environment_) ::setenv(name.c_str(), value.c_str(), 1);
}

MockHeadset::~MockHeadset() {
  for (const auto& [name, value] : environment_) ::unsetenv(name.c_str());
  ::munmap(control_, sizeof(MockControl));
}

void MockHeadset::Put(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& turn) {
  ++control_->pose_serial;
  control_->head.position = {position_m.x(), position_m.y(), position_m.z()};
  control_->head.quaternion = {turn.x(), turn.y(), turn.z(), turn.w()};
  ++control_->pose_serial;
}

void MockHeadset::Tell(MockEvent event) {
  control_->events.at(static_cast<std::size_t>(control_->event_serial.load())) = event;
  ++control_->event_serial;
}

std::array<MockPicture, 2> MockHeadset::Pictures() const {
  for (;;) {
    const std::int32_t before = control_->picture_serial;
    std::array<MockPicture, 2> pictures = control_->pictures;
    std::atomic_thread_fence(std::memory_order_acquire);
    if (before % 2 == 0 && control_->picture_serial == before) return pictures;
  }
}

}  // namespace elbowroom::test_support
