// Results that are used again are like new ones.
#include "app/control/frame_result_pool.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace elbowroom::control {
namespace {

TEST(FrameResultPool, KeepsMemoryAndNothingElse) {
  FrameResultPool pool;
  std::shared_ptr<FrameResult> result = pool.Take();
  const auto frames = std::make_shared<const recon::FrameSet>();
  result->record.frame = 7;
  result->camera_frames = frames;
  result->record.contacts.resize(2);
  result->record.contacts[1].points.resize(50);
  const core::ContactPoint* memory = result->record.contacts[1].points.data();
  result.reset();
  EXPECT_EQ(frames.use_count(), 1);  // given up at once
  const std::shared_ptr<FrameResult> again = pool.Take();
  EXPECT_EQ(again->record.frame, FrameResult().record.frame);
  EXPECT_EQ(again->camera_frames, nullptr);
  ASSERT_EQ(again->record.contacts.size(), 2U);
  EXPECT_EQ(again->record.contacts[1].points.data(), memory);
}

TEST(FrameResultPool, NeverHandsOutWhatIsHeld) {
  FrameResultPool pool;
  std::vector<std::shared_ptr<FrameResult>> held;
  for (int i = 0; i < 10; ++i) held.push_back(pool.Take());
  for (std::size_t i = 1; i < held.size(); ++i) EXPECT_NE(held[i], held[i - 1]);
  held.resize(3);
  const std::shared_ptr<FrameResult> next = pool.Take();
  for (const auto& result : held) EXPECT_NE(result, next);
}

TEST(FrameResultPool, ResultsMayOutliveIt) {
  std::shared_ptr<FrameResult> result = FrameResultPool().Take();
  result->record.frame = 3;
  EXPECT_EQ(std::exchange(result, nullptr)->record.frame, 3);
}

}  // namespace
}  // namespace elbowroom::control
