#include "tests/recon/capture/live_accounts.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace elbowroom::recon::testing {

void LiveAccounts::Add(const FrameSet& set) {
  for (core::CameraIndex i = 0; i < set.cameras.size(); ++i) {
    const auto& stamp = set.cameras[i].stamp;
    if (!stamp) continue;
    Enter(i, stamp->picture, stamp->picture, "in a set");
    ++judged_;
  }
  for (const core::PictureLoss& loss : set.losses) {
    Enter(loss.camera, loss.first, loss.last, core::ToString(loss.reason));
    lost_[loss.reason] += loss.count();
  }
}

std::uint64_t LiveAccounts::lost(core::LossReason reason) const {
  const auto found = lost_.find(reason);
  return found == lost_.end() ? 0 : found->second;
}

void LiveAccounts::ExpectWhole() const {
  for (const Book& book : books_) {
    ASSERT_TRUE(book.next.has_value());
    constexpr std::uint64_t kStillToCome = 8;
    if (book.beyond.empty()) continue;
    EXPECT_LE(*book.beyond.rbegin(), *book.next + kStillToCome) << "picture " << *book.next << " is nowhere";
  }
}

void LiveAccounts::Enter(core::CameraIndex camera, std::uint64_t first, std::uint64_t last,
                         std::string_view what) {
  Book& book = books_.at(camera);
  if (!book.next) book.next = book.begin = first;
  for (std::uint64_t n = std::max(first, book.begin); n <= last; ++n) {
    const bool is_new = n >= *book.next && book.beyond.insert(n).second;
    EXPECT_TRUE(is_new) << "camera " << camera << ": picture " << n << " is entered again, as " << what;
  }
  while (book.beyond.erase(*book.next) > 0) ++*book.next;
}

}  // namespace elbowroom::recon::testing
