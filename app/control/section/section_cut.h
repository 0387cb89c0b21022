// Planes at any angle that cut parts and hull open.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "recon/exact_view/half_space.h"

namespace elbowroom::control {

// What isn't in all of the half-spaces isn't shown.
struct SectionCut {
  std::vector<recon::HalfSpace> kept = {};  // in world

  [[nodiscard]] bool is_none() const { return kept.empty(); }
  [[nodiscard]] bool Keeps(const Eigen::Vector3d& x_in_world) const;
  [[nodiscard]] bool operator==(const SectionCut&) const = default;
};

// What the planes leave of what is in a box: all of it, nothing, or they may go through it. A box that lies
// on a plane with a face is beyond it, as a face has no thickness.
enum class BoxKept { kAll, kNothing, kMaybeCut };
[[nodiscard]] BoxKept KeptOf(const SectionCut& cut, const Eigen::AlignedBox3d& box_in_world);

// Whether the segment meets what the planes leave of the box.
[[nodiscard]] bool MeetsKept(const SectionCut& cut, const Eigen::AlignedBox3d& box_in_world,
                             const Eigen::Vector3d& from_in_world, const Eigen::Vector3d& to_in_world);

}  // namespace elbowroom::control
