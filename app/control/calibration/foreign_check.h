// What a foreign rig's numbers mean, found out by a board that its cameras see.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "recon/calibration/calibration_input.h"
#include "recon/calibration/rig_check.h"
#include "recon/rig_files/foreign_rig.h"

namespace elbowroom::control {

// What somebody says about a file; nothing: the format's documentation, or the check, decides.
struct StatedConvention {
  std::optional<recon::RigConvention::Pose> pose;
  std::optional<recon::RigConvention::Axes> axes;
  std::optional<core::LengthUnit> unit;
};

// The cameras of a check in a foreign rig, whose own order may mean something (a chain).
struct MatchedRig {
  recon::ForeignRig rig;
  std::vector<std::size_t> places;  // for each camera of the check, its place in the rig
};
// recon::CalibrationsOf, in the order of the check.
[[nodiscard]] std::vector<core::CameraCalibration> CalibrationsIn(const MatchedRig& matched,
                                                                  const recon::RigConvention& convention,
                                                                  double unit_mm);

struct TriedConvention {
  recon::RigConvention convention;
  std::optional<recon::RigCheck> check;  // nothing: it can't be so, as its cameras stand in one place
};

struct FoundConvention {
  recon::RigConvention convention;
  double unit_mm = 1.0;                  // the length of the file's unit
  std::optional<core::LengthUnit> unit;  // nothing: none that has a name
  std::optional<recon::RigCheck> check;  // with that unit; its scale is what the board says, over unit_mm
  std::vector<TriedConvention> tried;    // the best first; empty: nothing was checked
  std::vector<std::string> warnings;
};

// An error of 5 mm at 1 m, by which the paper's own hull is off, is an error of 0.005 in the image plane: of
// a camera that sees 1 m in 1 m, half a percent of the picture's width. A rig that is further off is of no
// use.
inline constexpr double kMostErrorShare = 0.005;
// Two causes of equal size make an error larger by the square root of 2. So a convention whose error isn't
// twice the best one's isn't refuted.
inline constexpr double kRefutedFactor = 2.0;
// A scale is taken for that of a unit if it is this near to it.
inline constexpr double kUnitTolerance = 0.05;

// Tries all conventions that the format and `stated` leave against the board. `matched`: with the cameras of
// `input`; all have sizes and poses. Throws: Error{kCamera}, one line with the figures: no convention
// is within kMostErrorShare in every camera, two different rigs are equally good, the stated unit isn't what
// the board says, or no two cameras see the board at once.
[[nodiscard]] FoundConvention FindConvention(const MatchedRig& matched, const recon::CalibrationInput& input,
                                             const StatedConvention& stated);

// Without a board: what is stated, and else documented, with warnings. Throws: Error{kFormat} if nothing says
// the unit.
[[nodiscard]] FoundConvention UncheckedConvention(const recon::ForeignRig& rig,
                                                  const StatedConvention& stated);

}  // namespace elbowroom::control
