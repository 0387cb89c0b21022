#include "tests/app/reviewing/recorded_sessions.h"

#include <fmt/format.h>

#include "app/control/demo_trial.h"
#include "app/control/outcome_tracker.h"
#include "app/control/silhouette_pipeline.h"
#include "app/control/trial_rules.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "sessions/session_writer.h"
#include "tests/support/hard_parts.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

constexpr core::FrameIndex kFirst = 50, kEnd = 90, kOneCameraLess = 66, kStill = 70, kStillTo = 74;
constexpr core::FrameIndex kBallMoves = 60;
constexpr double kFrameS = 1.0 / 15.0;

core::Part PartOf(const char* name, core::TriangleMesh mesh, const Eigen::Vector3d& at_mm) {
  core::Part part;
  part.name = name;
  part.mesh = std::make_shared<const core::TriangleMesh>(std::move(mesh));
  part.world_from_part.translation_mm = at_mm;
  return part;
}

core::Layout OtherShapes() {
  core::Layout layout;
  layout.parts.push_back(PartOf("needles", test_support::NeedleForestMesh(160.0, 90.0, 1200), {0, 0, 0}));
  layout.parts.push_back(PartOf("ball", test_support::SphereMesh(70.0, 800), {0, 0, 300}));
  layout.parts.push_back(PartOf("wall", test_support::ScanMesh(200.0, 900, 3), {150, 0, 150}));
  layout.spacings.push_back({"ball_gap", "ball", "needles", core::Axis::kZ, 20.0, 300.0, 90.0});
  layout.spacings.push_back({"wall_gap", "wall", "needles", core::Axis::kX, 0.0, 200.0, 60.0});
  return layout;
}

core::SessionHeader OtherHeader(const core::Rig& rig) {
  core::SessionHeader header;
  header.rig = rig;
  header.layout = OtherShapes();
  header.trial.required_clearance_mm = 12.0;
  header.trial.uncertainty_mm = 0.5;
  header.trial.tools = {"tongs"};
  return header;
}

SilhouetteFrame FrameOf(const recon::SyntheticRig& source, core::FrameIndex frame) {
  const core::FrameIndex seen = frame >= kStill && frame < kStillTo ? kStill : frame;
  SilhouetteFrame result;
  result.frame = frame;
  result.time_s = static_cast<double>(frame) * kFrameS;
  const std::vector<core::BitMask> masks = source.TrueMasks(source.ObjectsAt(2 * seen));
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const bool is_missing = frame == kOneCameraLess && i == 1;
    core::BitMask mask = masks[i];
    if (is_missing) mask.SetAll();
    result.masks.push_back({std::move(mask), {}});
    result.stamps.push_back(
        core::CameraStamp{static_cast<std::uint64_t>(frame), result.time_s + 0.004 * static_cast<double>(i)});
    if (is_missing) result.stamps.back().reset();
  }
  return result;
}

}  // namespace

// Each range is played once a process.
void RecordDemo(const std::filesystem::path& session, FrameRange frames) {
  static const test_support::TemporaryFolder folder;
  const std::filesystem::path played = folder / fmt::format("{}-{}.db", frames.first, *frames.end);
  if (!std::filesystem::exists(played)) RecordDemo(played, frames, MakeDemoTrial(DemoPlay::kOnce));
  std::filesystem::copy_file(played, session);
}

void RecordDemo(const std::filesystem::path& session, FrameRange frames, const TrialSetup& setup) {
  TrialOptions options;
  options.session = session;
  options.frames = frames;
  TrialControls controls;
  (void)RunTrial(setup, options, controls, {});
}

void RecordOtherShapes(const std::filesystem::path& session) {
  const recon::SyntheticRig source(recon::FourCameraRig(),
                                   [](double time_s) { return recon::DemoSceneAt(time_s).objects; });
  const core::SessionHeader header = OtherHeader(source.rig());
  SilhouettePipeline pipeline(header.rig, header.layout,
                              ReviewOptionsOf(header.trial, header.rig, header.rig_quality));
  OutcomeTracker tracker(header.trial, pipeline.part_trees());
  sessions::SessionWriter writer(session, header);
  std::vector<double> gaps_mm = header.layout.InitialSpacings();
  const std::vector<std::string> tools;
  for (core::FrameIndex frame = kFirst; frame < kEnd; ++frame) {
    if (frame == kBallMoves) {
      writer.Append(core::SessionEvent{frame, static_cast<double>(frame) * kFrameS,
                                       core::SpacingChanged{"ball_gap", gaps_mm[0], 60.0}});
      gaps_mm[0] = 60.0;
    }
    const auto result = pipeline.Process(FrameOf(source, frame), gaps_mm);
    tracker.Add(*result, tools);
    writer.Append(result->record);
  }
  writer.Finish(tracker.Outcome());
}

}  // namespace elbowroom::control
