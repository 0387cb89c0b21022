// A rod of known diameter, moved through the workspace: measured in each frame, and whether the rig passes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/progress.h"
#include "core/rig_quality.h"
#include "core/soft_mask.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/gauge/rod_gauge.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

struct TrueRod {
  double diameter_mm = 0.0;         // > 0
  std::optional<double> length_mm;  // > 0; nothing: the length isn't judged
};

// What the frames show, in memory.
struct GaugeFrames {
  recon::RigFile rig_file;
  recon::UndistortedPlanes planes;
  std::vector<core::FrameIndex> frames;
  std::vector<std::vector<core::SoftMask>> masks;  // by frame, one a camera
  // By frame: a camera whose picture is missing in it; "": none. Such a frame isn't measured.
  std::vector<std::string> lacking_camera;
};

// In ascending order, each once. Throws: core::Error for the rig's files and for a frame that they don't
// have; Error{kCancelled}.
[[nodiscard]] GaugeFrames ReadGaugeFrames(const std::filesystem::path& rig_file,
                                          std::vector<core::FrameIndex> frames,
                                          const core::Progress& progress, const std::stop_token& stop);

// One frame: the rod at one place.
struct GaugePlace {
  core::FrameIndex frame = 0;
  recon::RodMeasurement rod;
  double error_mm = 0.0;                  // of the diameter: measured less true
  std::optional<double> length_error_mm;  // where a length is known and was measured
  std::vector<std::string> faults;        // plain lines; none: it passes

  [[nodiscard]] bool passed() const { return faults.empty(); }
};

struct GaugeOutcome {
  TrueRod truth;
  std::vector<GaugePlace> places;           // not empty
  std::size_t worst = 0;                    // of the largest |error_mm|
  std::optional<std::size_t> worst_length;  // of the largest length error; or the surest length
  std::optional<std::size_t> worst_straightness;
  std::vector<std::string> faults;    // of the gauge as a whole
  std::vector<std::string> warnings;  // plain lines

  [[nodiscard]] bool passed() const;
  [[nodiscard]] const GaugePlace& worst_place() const { return places[worst]; }
};

// Frames in which no rod is found become warnings. Throws: Error{kGeometry} if it is found in none, with what
// was seen; Error{kCancelled}.
[[nodiscard]] GaugeOutcome GaugeRig(const GaugeFrames& frames, const TrueRod& truth,
                                    const core::Progress& progress, const std::stop_token& stop);

// What RIG.yml keeps of it.
[[nodiscard]] core::RigGauge RigGaugeOf(const GaugeOutcome& outcome);

}  // namespace elbowroom::control
