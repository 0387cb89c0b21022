// The lines of sight to a rod's sides, and the cylinder that touches them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "recon/gauge/cylinder.h"
#include "recon/gauge/rod_search.h"

namespace elbowroom::recon {

struct FittedRod {
  std::vector<TangentSight> sights;
  std::vector<double> limits_mm;  // how far off each may be
  std::vector<int> cameras;       // that have sights, in order
  CylinderFit fit;
  double from_mm = 0.0;  // of the sights' touches, along the axis from its point
  double to_mm = 0.0;

  [[nodiscard]] std::vector<std::size_t> SightsOf(int camera) const;
};

// Points that are far off their side's line, as where a hand begins, are left out.
[[nodiscard]] FittedRod FitRod(std::span<const RodView> views, const FoundRod& found,
                               const BoundaryLimits& limits);

}  // namespace elbowroom::recon
