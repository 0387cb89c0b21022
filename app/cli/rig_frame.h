// One frame of a rig, as the commands that look at a single frame need it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <vector>

#include "app/cli/options/command.h"
#include "core/ids.h"
#include "core/rig.h"
#include "core/rig_quality.h"
#include "core/soft_mask.h"
#include "recon/contours/undistorted_plane.h"

namespace elbowroom::cli {

struct RigFrameOptions {
  std::filesystem::path rig_file;
  core::FrameIndex frame = 0;
};

// Adds RIG.yml and --frame.
void AddRigFrameOptions(CLI::App& command, RigFrameOptions* options);

struct RigFrame {
  std::shared_ptr<const core::Rig> rig;
  // One a camera: ready masks, or segmented with the default options, with boundaries between pixels.
  std::vector<core::SoftMask> masks;
  core::RigQuality quality;
  recon::UndistortedPlanes planes;  // with all that depends on the rig alone, which no frame's time includes
};

// Throws: core::Error for the rig's files and for a frame out of range.
[[nodiscard]] RigFrame LoadRigFrame(const RigFrameOptions& options, const CommandContext& context);

}  // namespace elbowroom::cli
