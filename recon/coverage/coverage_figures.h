// The four quantities over many nodes, in numbers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

#include "core/spread.h"
#include "recon/coverage/rig_coverage.h"

namespace elbowroom::recon {

struct CoverageFigures {
  std::size_t nodes = 0;
  // Nothing: no node has the value.
  std::optional<core::Spread> uncertainty_mm;
  std::optional<core::Spread> footprint_mm;
  std::optional<core::Spread> cameras_seeing;  // a larger number is better: `fewest_cameras` is the worst
  std::optional<core::Spread> phantom_fraction;
  int fewest_cameras = 0;
  double unseen_share = 0.0;               // of the nodes, those that no camera sees
  double seen_share = 0.0;                 // that two cameras or more see
  double reach_share = 0.0;                // at which the unseen policy lets a thing be in the hull
  std::size_t without_sigma = 0;           // nodes without an uncertainty
  std::size_t without_phantom = 0;         // nodes without a phantom fraction
  std::optional<std::size_t> worst_sigma;  // number of the node
  std::optional<std::size_t> worst_phantom;
};

[[nodiscard]] CoverageFigures FiguresOf(std::span<const CoverageNode> nodes);

}  // namespace elbowroom::recon
