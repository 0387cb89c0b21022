// The paper's scenes do what they are for: the curtain is pushed, the water is caught.
#include "app/control/samples/sample_trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/control/frame_pipeline.h"
#include "recon/synthetic/sample_motion.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::control {
namespace {

// A sample's frames from the exact silhouettes, 15 a second.
class SampleRun {
 public:
  explicit SampleRun(Sample sample)
      : setup_(MakeSampleTrial(sample)),
        rig_(dynamic_cast<recon::SyntheticRig&>(*setup_.source)),
        pipeline_(rig_.rig(), setup_.layout,
                  std::vector<recon::BackgroundReference>(rig_.rig().cameras.size()), setup_.segmentation) {}

  // The frame at that time, after all frames before it.
  SharedFrameResult At(double time_s) {
    SharedFrameResult result;
    for (; rig_.TimeOfFrameS(next_) <= time_s; ++next_) {
      recon::FrameSet frames;
      frames.index = next_;
      frames.time_s = rig_.TimeOfFrameS(next_);
      for (core::BitMask& mask : rig_.TrueMasks(rig_.ObjectsAt(next_)))
        frames.cameras.push_back({{}, std::move(mask)});
      result = pipeline_.Process(frames, {});
    }
    return result;
  }

 private:
  TrialSetup setup_;
  recon::SyntheticRig& rig_;
  FramePipeline pipeline_;
  core::FrameIndex next_ = 0;
};

// The farthest that a vertex of the curtain is from its plane.
double CurtainMovedMm(const FrameResult& result) {
  const core::SharedMesh& mesh = result.response->meshes_in_world.at(1);
  double farthest = 0.0;
  for (const Eigen::Vector3d& vertex : mesh->vertices_mm)
    farthest = std::max(farthest, std::abs(vertex.x() - recon::kCurtainXMm));
  return farthest;
}

TEST(SampleTrial, TheCurtainIsPushedByTheHands) {
  SampleRun run(Sample::kCurtain);
  EXPECT_LT(CurtainMovedMm(*run.At(0.2)), 5.0);
  EXPECT_GT(CurtainMovedMm(*run.At(5.5)), 40.0);
}

TEST(SampleTrial, TheWaterStaysInTheHands) {
  constexpr double kBowlFromMm = 150.0, kBowlToMm = 290.0;
  SampleRun run(Sample::kFaucet);
  const auto slow_above_basin = [&](double time_s) {
    const SharedFrameResult result = run.At(time_s);
    return std::ranges::count_if(result->response->streams.at(0).particles, [](const auto& particle) {
      return particle.x_in_world.z() > kBowlFromMm && particle.x_in_world.z() < kBowlToMm;
    });
  };
  const auto falling = slow_above_basin(1.0), caught = slow_above_basin(5.0);
  EXPECT_GT(falling, 0);
  EXPECT_GT(caught, 2 * falling);
}

TEST(SampleTrial, EachHasANameAndALayoutThatIsValid) {
  for (const Sample sample : kSamples) {
    EXPECT_EQ(ParseSample(ToString(sample)), sample);
    const TrialSetup setup = MakeSampleTrial(sample);
    setup.layout.Validate();
    EXPECT_FALSE(setup.info.task.empty());
    EXPECT_FALSE(setup.source->frame_count().has_value());
  }
  EXPECT_FALSE(ParseSample("bathtub").has_value());
}

}  // namespace
}  // namespace elbowroom::control
