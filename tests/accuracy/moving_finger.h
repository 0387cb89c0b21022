// The paper's practical test ("Accuracy Summary"): a finger about 1 cm across is moved around the
// reconstruction volume, and how wide its reconstruction is there.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/synthetic/solids.h"
#include "tests/accuracy/hull_section.h"

namespace elbowroom::accuracy {

inline constexpr double kFingerMm = 10.0;          // across
inline constexpr double kFingerLengthMm = 80.0;    // that stands out of the fist
inline constexpr double kPaperHullMm = 5.0;        // the paper's estimate of the hull's error
inline constexpr double kPaperRenderingMm = 15.0;  // and of the rendering's, on planes kPaperSpacingMm apart

// Where the participant's eyes are: before the middle of the table's near side, as one who stands there.
inline const Eigen::Vector3d kEyeInWorld(0.0, -900.0, 850.0);

inline constexpr std::array<const char*, 3> kFingerDirections = {"left", "down", "ahead, 30° up"};

struct FingerPlace {
  int number = 0;
  Eigen::Vector3d middle_in_world = Eigen::Vector3d::Zero();  // of what stands out of the fist
  Eigen::Vector3d axis_in_world = Eigen::Vector3d::UnitX();   // unit, to the tip
  std::string direction;                                      // of the tip: one of kFingerDirections
  int cameras = 0;  // that have the finger's middle in their picture
};

// The middles of the cells into which the workspace is cut, in each the finger to the left, down, and away
// from the participant and 30 degrees up. It is nowhere seen nearer to end-on than 20 degrees.
[[nodiscard]] std::vector<FingerPlace> FingerPlaces(const core::Rig& rig, const Eigen::Vector3i& cells);

enum class FingerHolder { kNothing, kFist };  // the finger alone, or on the demo's hand with its arm

// The finger comes first.
[[nodiscard]] std::vector<recon::Solid> FingerSolids(const FingerPlace& place, FingerHolder holder);

[[nodiscard]] SectionPlane SectionAt(const FingerPlace& place);

struct FingerWidths {
  std::optional<SectionWidths> in_hull;  // nothing: the finger is lost there
  std::optional<double> on_planes_mm;    // as seen; nothing: lost, or not measured
};

struct FingerReconstruction {
  std::string name;
  int draws = 1;          // of what is random
  bool is_drawn = false;  // on planes, too
  std::function<FingerWidths(const FingerPlace&, int draw)> widths;
};

[[nodiscard]] FingerReconstruction PerfectCameras(const core::Rig& rig, FingerHolder holder);

// Perfect silhouettes of the finger on its fist, boundaries between pixels (oracles::CoverageMask), by the
// places' numbers. They take most of the time.
using FingerMasks = std::map<int, std::vector<core::SoftMask>>;
[[nodiscard]] FingerMasks PerfectMasksOf(const core::Rig& rig, std::span<const FingerPlace> places);
// Throws: std::out_of_range for a place without masks.
[[nodiscard]] FingerReconstruction PerfectMasks(const core::Rig& rig, FingerMasks masks);

// The budget's "all together": cameras off by 0.1 degrees and 1 mm and up to 33 ms apart before a hand at 500
// mm/s, pictures with 2 % of noise, segmented. One draw is one calibration, kept for all places.
[[nodiscard]] FingerReconstruction DisturbedRig(const core::Rig& rig, int draws);

// All draws of the first place, then those of the next. Parallel; the same for any number of threads.
[[nodiscard]] std::vector<FingerWidths> MeasureWidths(const FingerReconstruction& reconstruction,
                                                      std::span<const FingerPlace> places);

struct WidthSummary {
  int measured = 0;
  int lost = 0;
  double median_mm = 0.0;     // of those that aren't lost, as the next three
  double low_mm = 0.0;        // 5 %
  double high_mm = 0.0;       // 95 %
  double worst_mm = 0.0;      // the one farthest from kFingerMm
  double within_share = 0.0;  // of all, how many are within `tolerance_mm` of kFingerMm
};

[[nodiscard]] WidthSummary Summarise(std::span<const std::optional<double>> widths_mm, double tolerance_mm);

}  // namespace elbowroom::accuracy
