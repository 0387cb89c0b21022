// From RIG.yml to what the rig can do at each place, and what to do about it.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/layout.h"
#include "core/progress.h"
#include "recon/coverage/coverage_figures.h"
#include "recon/coverage/next_camera.h"
#include "recon/coverage/rig_coverage.h"

namespace elbowroom::control {

struct CoverageRequest {
  std::filesystem::path rig_file;
  std::filesystem::path layout;      // empty: none
  std::optional<double> grid_mm;     // > 0; nothing: 20 mm, wider or narrower by the workspace's size
  std::optional<double> ball_mm;     // > 0; nothing: 50 mm, smaller in a small workspace
  double near_mm = 100.0;            // > 0; how far from a part's surface counts as near it
  std::optional<double> ceiling_mm;  // no camera is proposed above this z; nothing: at any height
  bool tries_cameras = true;         // looks for the next camera
};

// The space near one part, within the workspace.
struct PartCoverage {
  std::string name;
  double grid_mm = 0.0;
  recon::CoverageFigures figures;  // of no nodes: the part isn't in the workspace
};

struct CoverageOutcome {
  recon::CalibratedRig rig;
  bool has_covariance = false;
  recon::CoverageOptions options;
  double near_mm = 0.0;
  recon::CoverageGrid grid;
  std::vector<recon::CoverageNode> nodes;  // of the grid
  recon::CoverageFigures figures;          // of the nodes
  core::Layout layout;                     // empty: none
  std::vector<core::RigidTransform> world_from_parts;
  std::vector<PartCoverage> parts;
  std::optional<recon::NextCamera> next;       // nothing: not looked for
  std::optional<double> exact_uncertainty_mm;  // median that is left if the cameras were exact
  std::vector<std::string> warnings;           // plain lines
  std::vector<std::string> advice;
  double map_ms = 0.0;     // for the nodes
  double advice_ms = 0.0;  // for the parts and the next camera
};

// A grid that is asked for may have so many nodes.
inline constexpr double kMostCoverageNodes = 4e6;

// Throws: core::Error as ReadRigFile and ImportLayoutFile; Error{kRange}: a grid with too many nodes;
// Error{kCancelled}.
[[nodiscard]] CoverageOutcome CoverRig(const CoverageRequest& request, const core::Progress& progress,
                                       const std::stop_token& stop);

}  // namespace elbowroom::control
