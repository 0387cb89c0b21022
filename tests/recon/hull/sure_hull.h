// The hull in long double, with an opinion on what an error of given size may change.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "tests/oracles/picture_labels.h"
#include "tests/recon/hull/sure.h"

namespace elbowroom::recon {

// How far off an answer may be.
struct StressError {
  double mm = 0.0;         // as if the point were that far away from where it is,
  double roundings = 0.0;  // that many half units in the last place (double) of every number used,
  double lens_px = 0.0;    // and, through a lens, its projection by that much
  [[nodiscard]] StressError Times(double share) const { return {share * mm, share * roundings, lens_px}; }
};

// Labels straight from the masks (oracles::PictureLabels), projection in long double; shares no code with
// recon's hull. Immutable. Thread: any.
class SureHull {
 public:
  SureHull(const core::Rig& rig, std::span<const core::SoftMask> masks);

  // Of all points that the error may make of this one: all in the hull, none, or not sure.
  [[nodiscard]] Sure Contains(const oracles::Vector3L& x_in_world, const StressError& error) const;

 private:
  struct Opinion {
    Sure is_object;
    Sure is_seen;
  };
  [[nodiscard]] Opinion Ask(std::size_t camera, const oracles::Vector3L& x_in_world,
                            const StressError& error) const;
  [[nodiscard]] Sure IsInWorkspace(const oracles::Vector3L& x_in_world, const StressError& error) const;

  const core::Rig& rig_;
  std::vector<oracles::PictureLabels> labels_;
  std::vector<oracles::PictureLabels> outlines_;  // what each camera sees
};

}  // namespace elbowroom::recon
