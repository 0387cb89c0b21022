// A trial before it starts: who, what, which rig, which layout, where the frames come from.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/layout.h"
#include "core/session.h"
#include "recon/frame_set.h"
#include "recon/segmentation.h"

namespace elbowroom::control {

// Something the experimenter is known to do at a frame: the demo's script.
struct ScriptedChange {
  core::FrameIndex frame = 0;
  std::string spacing;
  double to_mm = 0.0;
};

struct TrialSetup {
  core::TrialInfo info;
  core::Layout layout;
  recon::SegmentationOptions segmentation;
  std::shared_ptr<recon::FrameSetSource> source;
  std::vector<ScriptedChange> script;  // by frame
  std::string end_note;                // what limits the footage, "" if nothing: goes into the session
  std::vector<std::string> warnings;   // of the files that were read
};

// TRIAL.toml (docs/user_guide.md) with its rig and layout. Nothing is decoded yet but the files' headers.
// Throws: core::Error with file, line and key for what the trial file has wrong; what the rig's and the
// layout's readers throw.
[[nodiscard]] TrialSetup ReadTrialFile(const std::filesystem::path& path);

// The settings that a session keeps, as text.
[[nodiscard]] std::map<std::string, std::string> SettingsOf(const recon::SegmentationOptions& options);

}  // namespace elbowroom::control
