// Planes across the world's axes that cut parts and hull open.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

namespace elbowroom::control {

struct CutPlane {
  double at_mm = 0.0;        // along its axis, in world
  bool keeps_above = false;  // what lies at larger coordinates stays; false: at smaller ones

  [[nodiscard]] bool operator==(const CutPlane&) const = default;
};

// One plane or none for each of x, y and z. What lies beyond any of them isn't shown.
struct SectionCut {
  std::array<std::optional<CutPlane>, 3> planes = {};

  [[nodiscard]] bool is_none() const { return !planes[0] && !planes[1] && !planes[2]; }
  [[nodiscard]] bool operator==(const SectionCut&) const = default;
};

// What stays: of the box that part which no plane cuts off. Empty: nothing.
[[nodiscard]] Eigen::AlignedBox3d KeptOf(const SectionCut& cut, const Eigen::AlignedBox3d& box_in_world);

}  // namespace elbowroom::control
