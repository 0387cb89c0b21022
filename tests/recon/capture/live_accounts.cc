#include "tests/recon/capture/live_accounts.h"

#include <gtest/gtest.h>

namespace elbowroom::recon::testing {

void LiveAccounts::Add(const FrameSet& set) {
  for (core::CameraIndex i = 0; i < set.cameras.size(); ++i)
    if (const auto& stamp = set.cameras[i].stamp) Enter(i, stamp->picture, stamp->picture, "in a set");
  for (const core::PictureLoss& loss : set.losses) {
    Enter(loss.camera, loss.first, loss.last, std::string(core::ToString(loss.reason)));
    lost_[loss.reason] += loss.count();
  }
}

std::uint64_t LiveAccounts::lost(core::LossReason reason) const {
  const auto found = lost_.find(reason);
  return found == lost_.end() ? 0 : found->second;
}

void LiveAccounts::ExpectWhole() const {
  for (const auto& numbers : numbers_) {
    ASSERT_FALSE(numbers.empty());
    constexpr std::uint64_t kStillToCome = 8;
    for (std::uint64_t n = numbers.begin()->first; n + kStillToCome < numbers.rbegin()->first; ++n)
      EXPECT_TRUE(numbers.contains(n)) << "picture " << n << " is nowhere";
  }
}

void LiveAccounts::Enter(core::CameraIndex camera, std::uint64_t first, std::uint64_t last,
                         const std::string& what) {
  for (std::uint64_t n = first; n <= last; ++n) {
    const auto [at, is_new] = numbers_.at(camera).emplace(n, what);
    EXPECT_TRUE(is_new) << "picture " << n << " is " << at->second << " and " << what;
  }
}

}  // namespace elbowroom::recon::testing
