// How a trial segments its pictures, as its session keeps it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/rig.h"
#include "recon/segmentation/segmentation_options.h"

namespace elbowroom::control {

// As SessionHeader::settings.
using Settings = std::map<std::string, std::string>;

// The settings that a session keeps, as text. Numbers read back exactly. Of a mask of pixels to ignore it is
// only their number; beside footage the masks are files (KeepIgnoredPixels).
[[nodiscard]] Settings SettingsOf(const recon::SegmentationOptions& options);

// The options that gave the settings, without masks. What an older session doesn't have has its default.
// Throws: core::Error{kFormat} naming the setting that isn't one of SettingsOf.
[[nodiscard]] recon::SegmentationOptions OptionsFrom(const Settings& settings, const core::Rig& rig);

// How many pixels of that camera were ignored, by the settings; 0: none.
[[nodiscard]] std::int64_t IgnoredPixelsOf(const Settings& settings, const core::CameraModel& camera);

// Where the mask of a camera's ignored pixels is in a folder of footage.
[[nodiscard]] std::filesystem::path IgnoredPixelsFile(const std::filesystem::path& footage,
                                                      core::CameraIndex camera);

// Writes the masks of the options beside the footage, so that it can be segmented again. Throws:
// core::Error{kFile}.
void KeepIgnoredPixels(const recon::SegmentationOptions& options, const core::Rig& rig,
                       const std::filesystem::path& footage);

}  // namespace elbowroom::control
