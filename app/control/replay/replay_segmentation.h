// The pictures of a session's frames, segmented again as a trial does it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/replay/session_footage.h"
#include "core/progress.h"
#include "core/session.h"
#include "recon/footage/recorded_rig.h"
#include "recon/segmentation/frame_segmenter.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

struct SegmentingOptions {
  std::filesystem::path settings;  // a file with [segmentation]; empty: the recorded settings
  std::filesystem::path rig;       // RIG.yml with other backgrounds, or, where the session names no footage,
                                   // with the pictures; empty: none
};

// What segmenting did, of one frame or of many.
struct SegmentingCount {
  std::int64_t pictures = 0;
  std::int64_t missing = 0;                  // pictures that were judged and aren't in the footage
  std::int64_t silhouettes_that_differ = 0;  // from the recorded ones
  recon::SegmentationStats stats = {};

  SegmentingCount& operator+=(const SegmentingCount& other);
};

// Thread: one at a time.
class ReplaySegmentation {
 public:
  // Checks and opens the footage, and reads the backgrounds. Throws: what FindFootage and
  // ReadSegmentationFile throw, and what sources throw that can't be opened; core::Error{kFormat}: a setting
  // of the session, or its mask of pixels to ignore, isn't known.
  ReplaySegmentation(const sessions::SessionReader& recorded, const SegmentingOptions& options,
                     const core::Progress& progress, const std::stop_token& stop);

  // In words, a line each; empty: settings and backgrounds are the recorded ones.
  [[nodiscard]] const std::vector<std::string>& changes() const { return changes_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return footage_.warnings; }
  [[nodiscard]] const std::filesystem::path& footage() const { return footage_.location; }

  // Puts in how the new session's silhouettes come about.
  void Describe(core::SessionHeader* header) const;

  // Replaces the frame's silhouettes by those of the pictures that were judged. A picture that a recorder
  // couldn't write is missing from then on, as if it had been lost: its silhouette is all object. Frames are
  // best asked for in order. Throws: core::Error{kFile} naming frame, camera and picture that should be in
  // the footage; {kRange} for a frame with no picture at all; what RecordedRig::ReadPictures throws.
  [[nodiscard]] SegmentingCount Segment(core::FrameRecord* frame, const std::stop_token& stop);

 private:
  void FindSettings(const SegmentingOptions& options);
  void TellChanges();
  [[nodiscard]] recon::FrameSet ReadFrames(core::FrameRecord* frame, SegmentingCount* count,
                                           const std::stop_token& stop);
  void ReadIgnoredPixels();

  const sessions::SessionReader& recorded_;
  SessionFootage footage_;
  std::filesystem::path backgrounds_;  // the rig that names other ones; empty: none does
  recon::SegmentationOptions settings_;
  std::optional<double> boundary_sigma_px_;  // of a file with settings
  std::vector<std::string> changes_;
  recon::RecordedRig pictures_;
  std::optional<recon::FrameSegmenter> segmenter_;
};

}  // namespace elbowroom::control
