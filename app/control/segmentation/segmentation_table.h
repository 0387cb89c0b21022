// The table [segmentation] of a trial file.
#pragma once

#include <filesystem>

#include "cad_import/layout/toml_entry.h"
#include "core/rig.h"
#include "core/rig_quality.h"
#include "recon/segmentation/segmentation_options.h"

namespace elbowroom::control {

struct SegmentationTable {
  recon::SegmentationOptions options;
  double boundary_sigma_px = core::kBoundarySigmaPx;
};

// Of the file `root`; what isn't there has its default. Reads the masks of pixels to ignore. Throws:
// core::Error with file, line and key for what is wrong, also of cameras that the rig doesn't have; what
// recon::ReadMaskImage throws.
[[nodiscard]] SegmentationTable ReadSegmentation(const cad_import::TomlEntry& root,
                                                 const std::filesystem::path& file, const core::Rig& rig);

// Of a trial file, or of one that has nothing but that table. Its rig and layout aren't looked at. Throws:
// core::Error{kFile} if it can't be read; {kFormat} if it has no [segmentation]; as above.
[[nodiscard]] SegmentationTable ReadSegmentationFile(const std::filesystem::path& file, const core::Rig& rig);

}  // namespace elbowroom::control
