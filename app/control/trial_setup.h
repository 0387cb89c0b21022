// A trial before it starts: who, what, which rig, which layout, where the frames come from.
#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "app/control/trial_controls.h"
#include "cad_import/layout/layout_sections.h"
#include "core/layout.h"
#include "core/rig_quality.h"
#include "core/session.h"
#include "recon/footage/frame_set.h"
#include "recon/recording/footage_recorder.h"
#include "recon/segmentation/segmentation.h"

namespace elbowroom::control {

// A change that the experimenter makes at a known frame; the demo's script consists of them.
struct ScriptedChange {
  core::FrameIndex frame = 0;
  std::variant<SpacingRequest, ToolRequest, StepRequest> what;
};

struct TrialSetup {
  core::TrialInfo info;
  core::Layout layout;
  std::filesystem::path layout_file;                     // empty: the layout has no file of the user's own
  std::vector<cad_import::LayoutSection> sections = {};  // that file's
  core::RigQuality rig_quality;  // with errors only where the trial doesn't say uncertainty_mm itself
  recon::SegmentationOptions segmentation;
  std::shared_ptr<recon::FrameSetSource> source;
  std::shared_ptr<recon::FootageRecorder> footage = nullptr;  // of `source`; null: only silhouettes are kept
  std::vector<ScriptedChange> script;                         // by frame
  std::vector<core::EventContent> opening;                    // recorded with the first frame
  std::string first_step;                                     // begun with the first frame; empty: none
  std::vector<std::string> warnings;                          // of the files that were read
};

// What TRIAL.toml, its base and its questionnaires say of the trial itself; its rig and layout aren't opened.
// Throws: core::Error with file, line and key for what one of them has wrong.
[[nodiscard]] core::TrialInfo ReadTrialInfo(const std::filesystem::path& path);

// Reads TRIAL.toml (docs/user_guide.md) with its rig and layout; opens the footage.
// Throws: core::Error with file, line and key for what the trial file has wrong; what the rig's and the
// layout's readers throw; Error{kCancelled}.
[[nodiscard]] TrialSetup ReadTrialFile(const std::filesystem::path& path, std::stop_token stop = {});

}  // namespace elbowroom::control
