// A share of docs/accuracy.md's "What the verdict words mean": one rig of small pictures, some short trials.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/accuracy/chain/chain_cameras.h"
#include "tests/accuracy/chain/chain_parts.h"
#include "tests/accuracy/chain/chain_rig.h"
#include "tests/accuracy/chain/chain_trial.h"
#include "tests/accuracy/chain/verdict_tally.h"
#include "tests/support/soak.h"

namespace elbowroom::accuracy {
namespace {

using core::Verdict;

TEST(VerdictChain, PartsAreClosed) {
  for (const core::SharedMesh& mesh : ChainPartMeshes()) {
    EXPECT_TRUE(core::IsWatertight(*mesh));
    EXPECT_GT(core::VolumeMm3(*mesh), 0.0);
  }
}

// Frame sets are of pictures that are a few ms apart, none of which is in two sets.
TEST(VerdictChain, CamerasRunFree) {
  ChainClock clock(4, 3);
  std::vector<std::int64_t> last(4, -1);
  double time_s = -1.0;
  for (int i = 0; i < 200; ++i) {
    const ChainClock::Set set = clock.Next();
    EXPECT_GT(set.time_s, time_s);
    time_s = set.time_s;
    for (std::size_t camera = 0; camera < last.size(); ++camera) {
      const ChainClock::Instant& instant = set.cameras[camera];
      EXPECT_GT(static_cast<std::int64_t>(instant.stamp.picture), last[camera]);
      last[camera] = static_cast<std::int64_t>(instant.stamp.picture);
      EXPECT_NEAR(instant.stamp.time_s, instant.true_s, 3e-3);
      EXPECT_NEAR(instant.stamp.time_s, set.time_s, 0.034);
    }
  }
  EXPECT_NEAR(time_s, 200.0 / 30.0, 0.2);
}

TEST(VerdictChain, AClearPartIsTruly) {
  ChainRigOptions options;
  options.picture_scale = 0.5;
  options.board_poses = 30;
  const ChainRig rig = MakeChainRig(options, 5);
  const ChainCameras cameras(rig.truth, 5);
  const auto backgrounds = cameras.TakeBackgrounds(5);
  std::array<VerdictTally, kRequiredMm.size()> tallies;
  std::uint64_t seed = 1;
  for (const ChainObject object : kChainObjects) {
    ChainTrialOptions trial;
    trial.object = object;
    trial.frames = 12 * test_support::SoakScale();
    trial.seed = seed++;
    for (const JudgedPart& part : RunChainTrial(rig, cameras, backgrounds, trial))
      for (std::size_t rule = 0; rule < kRequiredMm.size(); ++rule)
        tallies[rule].Add(part.true_mm, part.verdicts[rule]);
  }
  for (std::size_t rule = 0; rule < kRequiredMm.size(); ++rule) {
    const VerdictTally& tally = tallies[rule];
    std::printf(
        "required %g mm: of %d parts %d touch; clear %d (%d of them touching), contact %d (%d of them "
        "apart), near %d, undecided %d\n",
        kRequiredMm[rule], static_cast<int>(tally.Count(kAnywhere)), static_cast<int>(tally.Count(kTouching)),
        static_cast<int>(tally.Count(Verdict::kClear, kAnywhere)),
        static_cast<int>(tally.Count(Verdict::kClear, kTouching)),
        static_cast<int>(tally.Count(Verdict::kContact, kAnywhere)),
        static_cast<int>(tally.Count(Verdict::kContact, kApart)),
        static_cast<int>(tally.Count(Verdict::kNear, kAnywhere)),
        static_cast<int>(tally.Count(Verdict::kUndecided, kAnywhere)));
  }
}

}  // namespace
}  // namespace elbowroom::accuracy
