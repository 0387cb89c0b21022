// The demo's motion as live pictures: what is served, and the rig that sees it.
#pragma once

#include <filesystem>
#include <tuple>
#include <vector>

#include "app/control/demo_trial.h"
#include "core/session.h"
#include "recon/footage/frame_set.h"
#include "recon/rig_files/rig_file.h"
#include "tests/recon/capture/served_rig.h"

namespace elbowroom::control {

inline constexpr int kCameras = 4;
// The demo's own rate; slow enough for a machine that also renders, sends and judges.
inline constexpr double kRateHz = 15.0;
// In these the hand lowers the pipe between the payloads, and touches them.
inline constexpr core::FrameIndex kFirst = 60, kSets = 60;

// The demo, some of its frame sets, and its empty scene.
struct DemoFootage {
  TrialSetup setup = MakeDemoTrial(DemoPlay::kForever);
  std::vector<recon::FrameSet> sets;
  std::vector<recon::BackgroundReference> backgrounds;
};
[[nodiscard]] DemoFootage RenderDemo();

// The rig with its live cameras, and pictures of the empty scene in `folder`.
[[nodiscard]] recon::RigFile LiveRigFile(const DemoFootage& footage, const recon::testing::ServedRig& served,
                                         const std::filesystem::path& folder);

// What was found of each part, as numbers that are equal for equal pictures.
using Found = std::vector<std::tuple<core::Verdict, std::int64_t, double>>;
[[nodiscard]] Found FoundIn(const core::FrameRecord& record);

}  // namespace elbowroom::control
