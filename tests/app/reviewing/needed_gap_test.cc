// The needed gap is what a sweep finds: the sweep is the oracle.
#include "app/control/reviewing/needed_gap.h"

#include <gtest/gtest.h>

#include "app/control/demo_parts.h"
#include "app/control/reviewing/what_if.h"
#include "app/control/sweep/spacing_sweep.h"
#include "core/error.h"
#include "review/spacing_study.h"
#include "tests/app/reviewing/recorded_sessions.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

TEST(NeededGap, IsThatOfASweep) {
  const test_support::TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches);
  const ReviewedSession session(folder / "s.db", {}, {});
  const NeededGap needed = FindNeededGap(session, kDemoGap, {}, {});
  const core::Spacing& spacing = session.header().layout.spacings[0];
  const SpacingSweep sweep = SweepSpacing(
      {{folder / "s.db"}, {kDemoGap, spacing.min_mm, spacing.max_mm, kNeededGapStepMm}, folder / "sweep"}, {},
      {});
  EXPECT_EQ(needed.touched_mm, sweep.all.all.largest_touched_mm);
  EXPECT_EQ(needed.free_mm, sweep.all.all.smallest_free_mm);
  EXPECT_EQ(needed.clear_mm, review::SmallestClearMm(sweep.all.all, sweep.moved));
  ASSERT_TRUE(needed.touched_mm && needed.free_mm && needed.clear_mm);
  EXPECT_GT(JudgeMotionAt(session, {{{kDemoGap, *needed.touched_mm}}}, {}, {}).parts[1].frames_in_contact, 0);
  EXPECT_EQ(JudgeMotionAt(session, {{{kDemoGap, *needed.free_mm}}}, {}, {}).parts[1].frames_in_contact, 0);
  EXPECT_EQ(JudgeMotionAt(session, {{{kDemoGap, *needed.clear_mm}}}, {}, {}).parts[1].verdict(),
            core::Verdict::kClear);
}

TEST(NeededGap, OfAGapThatIsNotThereIsRefused) {
  const test_support::TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 62});
  EXPECT_THROW((void)FindNeededGap(ReviewedSession(folder / "s.db", {}, {}), "no_gap", {}, {}), core::Error);
}

}  // namespace
}  // namespace elbowroom::control
