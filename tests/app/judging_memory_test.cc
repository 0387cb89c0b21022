// Judging needs no new memory, once it has met what it will meet.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <memory>
#include <vector>

#include "app/control/demo_parts.h"
#include "app/control/frame_judge.h"
#include "app/control/frame_result_pool.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/support/allocation_count.h"

namespace elbowroom::control {
namespace {

using test_support::AllocationCount;
using test_support::AllocationsSoFar;

constexpr core::FrameIndex kPlayedFrames = 360,
                           kPlayedStep = 4;  // all of the demo's motion, every fourth frame

// Hulls of the demo's exact masks, ready to be asked.
std::vector<SharedHull> DemoHulls() {
  const recon::SyntheticRig source(recon::FourCameraRig(),
                                   [](double time_s) { return recon::DemoSceneAt(time_s).objects; });
  const auto rig = std::make_shared<const core::Rig>(source.rig());
  const recon::UndistortedPlanes planes = recon::MakeUndistortedPlanes(*rig);
  std::vector<SharedHull> hulls;
  for (core::FrameIndex frame = 0; frame < kPlayedFrames; frame += kPlayedStep) {
    std::vector<core::SoftMask> masks;
    for (core::BitMask& mask : source.TrueMasks(source.ObjectsAt(frame)))
      masks.emplace_back().mask = std::move(mask);
    hulls.push_back(recon::NextHull(nullptr, rig, planes, masks).hull);
    hulls.back()->Prepare();
  }
  return hulls;
}

struct Round {
  AllocationCount judging;
  int contacts = 0;
};

review::PartReviewOptions OptionsWithClearance() {
  review::PartReviewOptions options;
  options.required_clearance_mm = 15.0;
  return options;
}

class Judging {
 public:
  explicit Judging(const core::Layout& layout) : layout_(layout), judge_(layout_, OptionsWithClearance()) {}

  Round Play(const std::vector<SharedHull>& hulls) {
    Round round;
    for (const SharedHull& hull : hulls) {
      const std::shared_ptr<FrameResult> result = results_.Take();
      result->hull = hull;
      result->world_from_parts = core::PosesAt(layout_, layout_.InitialSpacings());
      const AllocationCount before = AllocationsSoFar();
      judge_.Judge(last_.get(), result.get());
      round.judging += AllocationsSoFar() - before;
      for (const core::PartContact& contact : result->record.contacts)
        round.contacts += contact.verdict == core::Verdict::kContact ? 1 : 0;
      last_ = result;
    }
    return round;
  }

 private:
  core::Layout layout_;
  FrameResultPool results_;
  FrameJudge judge_;
  SharedFrameResult last_;
};

class JudgingMemory : public testing::TestWithParam<int> {};

TEST_P(JudgingMemory, TheSecondRoundAllocatesNothing) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(GetParam()));
  const std::vector<SharedHull> hulls = DemoHulls();
  core::Layout pushed = DemoLayout(), hinged = DemoLayout();
  for (core::Part& part : pushed.parts)
    part.recovery = {core::RecoveryKind::kSlider, {}, Eigen::Vector3d(0, 2, 0), {}};
  for (core::Part& part : hinged.parts)
    part.recovery = {core::RecoveryKind::kHinge, {}, Eigen::Vector3d(0, 2, 0), Eigen::Vector3d(500, 0, 0)};
  for (const core::Layout& layout : {DemoLayout(), pushed, hinged}) {
    Judging judging(layout);
    const Round first = judging.Play(hulls), second = judging.Play(hulls), third = judging.Play(hulls);
    EXPECT_GT(first.judging.allocations, 0);  // they are counted
    EXPECT_GT(first.contacts, 0);
    EXPECT_LT(first.contacts, static_cast<int>(3 * hulls.size()));
    EXPECT_EQ(third.judging.allocations, 0);
    EXPECT_EQ(second.judging.allocations, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, JudgingMemory, testing::Values(1, 2));

}  // namespace
}  // namespace elbowroom::control
