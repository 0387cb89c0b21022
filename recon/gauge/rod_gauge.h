// A rod of known diameter, measured by the silhouettes of one frame: what the rig makes of it, with a bound.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/gauge/rod_view.h"

namespace elbowroom::recon {

// Of how much each source may make a figure wrong, mm. The sum is the bound.
struct GaugeBound {
  double silhouettes_mm = 0.0;  // boundaries of both sides
  double distance_mm = 0.0;     // of the rod from the cameras, by the boundaries of all
  double calibration_mm = 0.0;  // kGaugeSigmas standard deviations of it; 0 if the rig has no covariance

  [[nodiscard]] double total_mm() const { return silhouettes_mm + distance_mm + calibration_mm; }
};
inline constexpr double kGaugeSigmas = 3.0;

struct BoundedMm {
  double value_mm = 0.0;
  GaugeBound bound;
};

enum class RodSight {
  kMeasured,  // sees both sides of the rod
  kAstray,    // sees a rod beside where the others do
  kRefutes,   // sees background where the others see the rod
  kBlind,     // the rod is hidden from it, points at it, or is out of its picture
};

struct CameraOfGauge {
  std::string name;
  RodSight sight = RodSight::kBlind;
  double distance_mm = 0.0;           // from the rod's middle
  std::optional<BoundedMm> diameter;  // by this camera's picture alone, where it measured
  // How far beside the rod of the other cameras this one sees it, across the line of sight. Nothing: fewer
  // than two others measure it, or they don't tell its axis.
  std::optional<BoundedMm> offset;
  double excess_px = 0.0;  // by so much its boundaries are beyond their limits for any straight rod
};

struct RodMeasurement {
  Eigen::Vector3d position_in_world;   // the middle of the seen stretch
  Eigen::Vector3d direction_in_world;  // unit, of the axis; the larger component is positive
  double seen_mm = 0.0;                // of the axis, by two cameras or more
  BoundedMm diameter;
  bool widths_agree = true;               // the cameras' ranges have a diameter in common
  std::optional<BoundedMm> straightness;  // the bow of the axis; nothing: not measurable
  std::optional<BoundedMm> length;        // nothing: an end is held or out of sight
  std::vector<CameraOfGauge> cameras;     // one a camera of the rig

  // Every camera that measures the rod sees it where the others do, and none refutes it.
  [[nodiscard]] bool CamerasAgree() const;
};

struct RodGaugeResult {
  std::optional<RodMeasurement> rod;
  std::string reason;  // where there is none: what was seen, and what to do
};

// Measures the rod nearest to `true_diameter_mm` that the masks show (docs/gauge.md). The diameter itself
// isn't used but to find it. `covariance`: as RIG.yml keeps it, or empty. Held to exact silhouettes and to
// made pictures by rod_gauge_test. Throws: PreconditionError for masks that aren't one a camera of its size,
// a diameter that isn't positive, or a covariance of another size. Thread: any.
[[nodiscard]] RodGaugeResult GaugeRod(const core::Rig& rig, const UndistortedPlanes& planes,
                                      std::span<const core::SoftMask> masks,
                                      const Eigen::MatrixXd& covariance, double true_diameter_mm,
                                      const BoundaryLimits& limits = {});

}  // namespace elbowroom::recon
