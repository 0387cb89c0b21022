// A trial's memory doesn't grow with its frames.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/trial_runner.h"
#include "recon/footage/frame_set.h"
#include "tests/support/resident_memory.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

// Pictures that are kept, spread over the demo's motion.
constexpr core::FrameIndex kPictures = 60, kStep = 6;
constexpr core::FrameIndex kFrames = 5000;  // times SoakScale()
constexpr double kFrameRateHz = 30.0;
// The first fifth may still grow: each picture is met, SQLite's cache fills.
constexpr core::FrameIndex kShareToSettle = 5;
// Allowed from then on, for pages that malloc doesn't use at times, and each touch's own row.
constexpr std::int64_t kMostGrowthBytes = 8 << 20;

// The demo's pictures from memory, over and over.
class KeptPictures : public recon::FrameSetSource {
 public:
  explicit KeptPictures(std::shared_ptr<recon::FrameSetSource> source) : source_(std::move(source)) {
    for (core::FrameIndex i = 0; i < kPictures; ++i) frames_.push_back(source_->Read(i * kStep));
  }

  [[nodiscard]] const core::Rig& rig() const override { return source_->rig(); }
  [[nodiscard]] std::optional<core::FrameIndex> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::string WhatEndsIt() const override { return ""; }
  [[nodiscard]] std::optional<recon::FrameSet> TryRead(core::FrameIndex index,
                                                       std::stop_token /*stop*/) override {
    recon::FrameSet frames = frames_[static_cast<std::size_t>(index % kPictures)];
    frames.index = index;
    frames.time_s = static_cast<double>(index) / kFrameRateHz;
    return frames;
  }
  [[nodiscard]] std::vector<recon::BackgroundReference> ReadBackgrounds(const core::Progress& progress,
                                                                        std::stop_token stop) override {
    return source_->ReadBackgrounds(progress, std::move(stop));
  }

 private:
  std::shared_ptr<recon::FrameSetSource> source_;
  std::vector<recon::FrameSet> frames_;
};

TEST(TrialMemory, IsFlatOverManyRecordedFrames) {
  const core::FrameIndex frames = kFrames * test_support::SoakScale();
  TrialSetup setup = MakeDemoTrial(DemoPlay::kForever);
  setup.source = std::make_shared<KeptPictures>(setup.source);
  const test_support::TemporaryFolder folder;
  TrialOptions options;
  options.session = folder / "trial.db";
  options.frames.end = frames;
  std::int64_t settled_bytes = 0, most_bytes = 0;
  options.on_frame = [&](const SharedFrameResult& /*result*/, const RecordedFrames& recorded) {
    if (recorded.seen % 100 != 0) return;
    const std::int64_t bytes = test_support::ResidentBytes(::getpid());
    const bool is_settled = recorded.seen * kShareToSettle >= frames;
    (is_settled ? most_bytes : settled_bytes) = std::max(is_settled ? most_bytes : settled_bytes, bytes);
  };
  TrialControls controls;
  const TrialOutcome outcome = RunTrial(setup, options, controls, {});
  EXPECT_EQ(outcome.frames, frames);
  EXPECT_EQ(outcome.frames_committed, frames);
  std::printf("resident after a fifth of %lld frames: %.1f MB; most after that: %.1f MB\n",
              static_cast<long long>(frames), static_cast<double>(settled_bytes) / 1e6,
              static_cast<double>(most_bytes) / 1e6);
  EXPECT_GT(settled_bytes, 0);
  EXPECT_LE(most_bytes, settled_bytes + kMostGrowthBytes);
}

}  // namespace
}  // namespace elbowroom::control
