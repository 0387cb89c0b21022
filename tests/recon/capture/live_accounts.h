// Keeps books of live pictures: which number of each camera is in a set, and which one is lost.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/picture_loss.h"
#include "recon/footage/frame_set.h"

namespace elbowroom::recon::testing {

// Every number is one of the two, once; another entry fails the test.
class LiveAccounts {
 public:
  explicit LiveAccounts(std::size_t cameras) : numbers_(cameras) {}

  void Add(const FrameSet& set);
  [[nodiscard]] std::uint64_t lost(core::LossReason reason) const;
  // Fails the test if a number between a camera's first and its last is nowhere; but for the last ones, whose
  // sets are still to come.
  void ExpectWhole() const;

 private:
  void Enter(core::CameraIndex camera, std::uint64_t first, std::uint64_t last, const std::string& what);

  std::vector<std::map<std::uint64_t, std::string>> numbers_;
  std::map<core::LossReason, std::uint64_t> lost_;
};

}  // namespace elbowroom::recon::testing
