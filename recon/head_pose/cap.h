// A cap with square markers on it: where each marker is, and where the eyes are below it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/rigid_transform.h"

namespace elbowroom::recon {

// Frame `marker`: the origin is the marker's middle, z looks out of the printed side, x runs to the right and
// y upwards in print.
struct CapMarker {
  int id = 0;
  double side_mm = 0.0;  // of the black square
  core::RigidTransform cap_from_marker;
};

// A rigid cap. Frame `cap`: that in which its markers were measured.
struct Cap {
  std::string name;
  std::string dictionary;  // as OpenCV names it: "DICT_4X4_50"
  std::vector<CapMarker> markers;
  core::RigidTransform cap_from_head;  // frame `head`: head_pose.h
  // How far each marker may be from where it is said to be, along each axis: a standard deviation, >= 0.
  double place_sigma_mm = 0.1;

  // Throws: Error{kRange} saying which marker must be what: no marker, one number twice, a side that isn't
  // positive, a place that isn't finite or farther than a metre from the cap's origin.
  void Validate() const;
};

// First column's and first row's corner, then clockwise in print, as DetectedMarker has them.
[[nodiscard]] std::array<Eigen::Vector3d, 4> CornersInCap(const CapMarker& marker);

// A marker with its middle at a place, its printed side looking along `normal`, its upper side towards `up`.
// Throws: PreconditionError: `normal` and `up` are parallel, or one of them is 0.
[[nodiscard]] core::RigidTransform CapFromMarker(const Eigen::Vector3d& middle_in_cap,
                                                 const Eigen::Vector3d& normal_in_cap,
                                                 const Eigen::Vector3d& up_in_cap);

// The head behind eyes that look along `forward`, with the crown of the head towards `up`. Throws: likewise.
[[nodiscard]] core::RigidTransform CapFromHead(const Eigen::Vector3d& eyes_in_cap,
                                               const Eigen::Vector3d& forward_in_cap,
                                               const Eigen::Vector3d& up_in_cap);

// The cap that docs/head_pose.md tells how to make: an eight-sided ring, 200 mm across, of markers of 50 mm
// that look 15 degrees upwards, and one of 100 mm on top. Cap frame: x right, y forward, z up, the origin in
// the ring's middle; the eyes are 80 mm before it and 90 mm below.
[[nodiscard]] Cap EightSidedCap();

}  // namespace elbowroom::recon
