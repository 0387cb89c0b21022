#include "tests/app/demo_frame.h"

#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"

namespace elbowroom::control {
namespace {

SharedFrameResult Judged(core::FrameIndex frame, double gap_mm) {
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  FramePipeline pipeline(setup.source->rig(), setup.layout, setup.source->ReadBackgrounds({}, {}),
                         setup.segmentation);
  return pipeline.Process(setup.source->Read(frame), std::vector<double>{gap_mm});
}

}  // namespace

SharedFrameResult DemoFrame(core::FrameIndex frame, double gap_mm) {
  if (frame != kFrameAtPayload || gap_mm != kGapNeededMm) return Judged(frame, gap_mm);
  static const SharedFrameResult kAtPayload = Judged(kFrameAtPayload, kGapNeededMm);
  return kAtPayload;
}

recon::SceneView DemoView() {
  recon::OrbitCamera camera;
  camera.target_in_world = {50.0, 0.0, 210.0};
  camera.distance_mm = 1350.0;
  return recon::ViewFrom(camera, 800, 600);
}

}  // namespace elbowroom::control
