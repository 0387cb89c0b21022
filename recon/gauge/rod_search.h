// Which strips of the cameras' silhouettes are one rod in space.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recon/gauge/cylinder.h"
#include "recon/gauge/straight_strips.h"

namespace elbowroom::recon {

// A strip as one camera has it of the rod.
struct RodStrip {
  int camera = 0;
  Strip strip;
  double offset_mm = 0.0;  // of its middle from the rod's axis, across the line of sight
};

struct FoundRod {
  Cylinder cylinder;     // roughly; its point is halfway along the seen stretch
  double from_mm = 0.0;  // the stretch that two cameras see, along the axis from the point
  double to_mm = 0.0;
  std::vector<RodStrip> agreeing;  // of two cameras or more
  std::vector<RodStrip> astray;    // of others: such a strip, but beside where these see the rod
};

struct RodSearch {
  std::optional<FoundRod> rod;
  std::string reason = {};  // why there is none: what was seen
};

// The rod of that diameter, within a factor of two, whose sides most cameras see at greatest length.
[[nodiscard]] RodSearch FindRod(std::span<const RodView> views, const Eigen::AlignedBox3d& workspace_mm,
                                double diameter_mm);

// Where the sight through a position of the plane passes the axis, along it from its point.
[[nodiscard]] double AlongAxis(const Cylinder& cylinder, const RodView& view,
                               const Eigen::Vector2d& position);

}  // namespace elbowroom::recon
