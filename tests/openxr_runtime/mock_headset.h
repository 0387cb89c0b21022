// A test's side of the small OpenXR runtime.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>

#include "core/rigid_transform.h"
#include "tests/openxr_runtime/mock_control.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::test_support {

// While it lives, programs that this process starts find the runtime. One at a time.
class MockHeadset {
 public:
  MockHeadset();
  ~MockHeadset();
  MockHeadset(const MockHeadset&) = delete;
  MockHeadset& operator=(const MockHeadset&) = delete;

  [[nodiscard]] MockControl& control() const { return *control_; }
  // Where the head is in OpenXR's frame: x to the right, y up, z back, m.
  void Put(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& turn);
  void Tell(MockEvent event);
  // Both eyes' pictures, whole.
  [[nodiscard]] std::array<MockPicture, 2> Pictures() const;
  // For a program that is started with an environment of its own.
  [[nodiscard]] const std::map<std::string, std::string>& environment() const { return environment_; }

 private:
  TemporaryFolder folder_;
  std::map<std::string, std::string> environment_;
  MockControl* control_ = nullptr;
};

}  // namespace elbowroom::test_support
