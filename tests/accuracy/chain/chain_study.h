// The simulated chain for one kind of rig: several calibrations, many short trials, all verdicts counted.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "tests/accuracy/chain/chain_trial.h"
#include "tests/accuracy/chain/verdict_tally.h"

namespace elbowroom::accuracy {

struct ChainStudyOptions {
  ChainRigOptions rig;
  int calibrations = 8;
  int trials = 25;  // of each calibration, the objects in turn
  int frames = 50;  // of each trial; every frame has all parts
  std::uint64_t seed = 1;
};

// Of one rule of kRequiredMm.
struct RuleFigures {
  VerdictTally tally;
  std::int64_t clear_but_nearer = 0;  // said `clear`, and truly nearer than the required clearance
  double most_missing_mm = 0.0;       // of those: how much nearer than required, at most
};

struct ChainFigures {
  int cameras = 0;
  std::int64_t frames = 0;
  std::vector<double> held_out_px, center_error_mm;  // by calibration
  std::array<RuleFigures, kRequiredMm.size()> rules;
  // Parts with bounds (JudgedPart::Bounds): whether the object is nowhere nearer than the lower bound less
  // what the verdict allows for. Where there is no hull, that bound is infinite.
  std::int64_t with_bounds = 0;
  std::int64_t nearer_than_bounds = 0;
  double most_below_bounds_mm = 0.0;
  std::int64_t without_hull = 0;  // they count to none of the three above
  std::vector<double> allowed_mm, calibration_mm, segmentation_mm, skew_mm;  // of those, U and 1 sigma each
  // Of parts that are truly apart: by how much nearer the hull is.
  std::vector<double> hull_excess_mm;
  std::vector<double> fastest_mm_per_s, most_skew_ms;  // of JudgedPart, by part
};

// Trials run in parallel; the result is the same for any number of threads.
[[nodiscard]] ChainFigures StudyChain(const ChainStudyOptions& options, const core::Progress& progress = {});

}  // namespace elbowroom::accuracy
