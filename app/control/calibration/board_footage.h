// Where the board is in every picture of a calibration.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/calibration/calibration_file.h"
#include "core/ids.h"
#include "core/progress.h"
#include "recon/boards/board_sighting.h"
#include "recon/footage/stamped_frames.h"

namespace elbowroom::control {

struct BoardPicture {
  core::FrameIndex frame = 0;
  recon::BoardSighting sighting;
};

struct CameraSightings {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  core::FrameIndex looked_at = 0;       // frames
  std::vector<BoardPicture> in_frames;  // in order
  core::FrameIndex photos = 0;          // pictures for the lens alone
  std::vector<BoardPicture> in_photos;
};

struct BoardFootage {
  std::vector<CameraSightings> cameras;
  // Frames that belong together. Without stamps frame i goes with frame i, and its time is i over the rate,
  // or 0 if there is no rate.
  std::vector<recon::StampedSet> sets;
  std::optional<double> period_s;     // between two frames; nothing: times are not known
  std::vector<std::string> warnings;  // plain lines about the footage, each with the camera's name
};

// At most this many sets are looked at. Longer footage is looked at in runs of three sets in a row, evenly
// spread: the board's motion between its neighbours is needed to find time offsets.
inline constexpr std::size_t kMostBoardSets = 480;

// Decodes one camera after the other, and looks for the board in many pictures at once. Throws: Error{kFile}
// and Error{kFormat} as recon::OpenUncalibratedSource and recon::ReadFrameStamps; Error{kCamera} if stamps
// and footage don't fit, or some cameras have stamps and others not; Error{kCancelled} on a stop.
[[nodiscard]] BoardFootage FindBoards(const CalibrationFile& file, const core::Progress& progress,
                                      const std::stop_token& stop);

// The sets again, after cameras turned out to be late: a picture with the stamp t shows the scene at
// t + offsets_s[camera]. Only frames that were looked at take part; their stamps stay as they were.
[[nodiscard]] std::vector<recon::StampedSet> SetsAfterOffsets(const BoardFootage& footage,
                                                              const std::vector<double>& offsets_s);

}  // namespace elbowroom::control
