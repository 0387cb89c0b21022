// The gap that a made motion needs.
#pragma once

#include <span>
#include <string>

#include "core/layout.h"
#include "recon/synthetic/highest_point.h"

namespace elbowroom::control {

// Of a spacing along z whose moving part has its widest level at its underside: what is highest below the
// part's extent in x and y, over the top of the reference. Thread: one.
class SpaceNeeded {
 public:
  // Throws: core::Error{kRange}: no such spacing; PreconditionError for another axis.
  SpaceNeeded(const core::Layout& layout, const std::string& spacing);

  void Add(std::span<const recon::SyntheticObject> objects);

  // The smallest at which nothing that was added is in the part, nor at any above; within the spacing's
  // limits.
  [[nodiscard]] double gap_mm() const;

 private:
  Eigen::AlignedBox2d below_mm_;
  double reference_top_mm_ = 0.0;
  double min_mm_ = 0.0, max_mm_ = 0.0;
  double highest_mm_ = 0.0;
};

}  // namespace elbowroom::control
