// Takes the empty scene with a rig's live cameras, as the background that pictures are compared with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/progress.h"
#include "recon/light/empty_scene.h"
#include "recon/rig_files/rig_file.h"
#include "recon/segmentation/noise_threshold.h"

namespace elbowroom::control {

struct BackgroundOptions {
  double seconds = 3.0;      // > 0; of pictures
  double countdown_s = 0.0;  // >= 0; before them, for people to leave; the cameras run already
  int min_blob_px = 200;     // >= 0; the least region that counts as something that moved
  bool anyway = false;       // true: take the background also where something moves or the light isn't steady

  // Throws: Error{kRange} naming the option that is out of range.
  void Validate() const;
};

struct CameraBackground {
  std::string name;
  int frames = 0;  // pictures in the folder
  recon::EmptySceneReport scene;
  // For one false candidate in a million pixels; nothing: all of the picture is clipped, or something moved.
  std::optional<recon::NoiseThreshold> suggested = std::nullopt;
  std::vector<std::string> faults = {};  // a sentence each; empty unless taken anyway
};

struct BackgroundOutcome {
  std::filesystem::path rig_file;  // in the folder
  std::vector<CameraBackground> cameras;
  double seconds = 0.0;     // that the pictures span
  std::uint64_t bytes = 0;  // of all pictures
};

// The folder gets RIG.yml, which is the rig with the new background and all else as it was, and the pictures
// themselves, without loss, as CAMERA/0000.png, ...: mean and noise of each pixel are measured from them
// whenever the rig is read. At most kMostPictures a camera are kept, evenly spread over the time; what moves
// beside them can do no harm. The folder appears whole or not at all. Throws: Error{kFile} unless the folder
// is new or empty; Error{kCamera} for a camera that can't be started or sends fewer than kLeastPictures, and
// where something moves or the light isn't steady, naming camera and place; Error{kFormat} for a rig that
// isn't live, or a name with '%', which can't be in a sequence's path; Error{kCancelled} on a stop.
[[nodiscard]] BackgroundOutcome TakeBackground(const recon::RigFile& rig_file,
                                               const std::filesystem::path& folder,
                                               const BackgroundOptions& options,
                                               const core::Progress& progress, const std::stop_token& stop);
inline constexpr int kMostPictures = 60, kLeastPictures = 10;

}  // namespace elbowroom::control
