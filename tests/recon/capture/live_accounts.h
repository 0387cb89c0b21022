// Keeps books of live pictures: each number of each camera is in a set, or it is lost.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/picture_loss.h"
#include "recon/footage/frame_set.h"

namespace elbowroom::recon::testing {

// Every number is one of the two, once; another entry fails the test. Its memory doesn't grow with time.
class LiveAccounts {
 public:
  explicit LiveAccounts(std::size_t cameras) : books_(cameras) {}

  void Add(const FrameSet& set);
  [[nodiscard]] std::uint64_t lost(core::LossReason reason) const;
  // Pictures in sets, of all cameras.
  [[nodiscard]] std::uint64_t judged() const { return judged_; }
  // Fails the test if a number between a camera's first and its last is nowhere; but for the last ones, whose
  // sets are still to come.
  void ExpectWhole() const;

 private:
  struct Book {
    std::uint64_t begin = 0;            // what was taken before the first entry doesn't count
    std::optional<std::uint64_t> next;  // all from the first number to here are entered
    std::set<std::uint64_t> beyond;     // entered, after a number that isn't yet
  };
  void Enter(core::CameraIndex camera, std::uint64_t first, std::uint64_t last, std::string_view what);

  std::vector<Book> books_;
  std::map<core::LossReason, std::uint64_t> lost_;
  std::uint64_t judged_ = 0;
};

}  // namespace elbowroom::recon::testing
