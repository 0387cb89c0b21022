// Where a point on a circle leaves the hull: exactly, by the circle's crossings with the silhouettes' edges.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

// x(angle) = center + cos(angle) * start + sin(angle) * quarter; `start` and `quarter` are perpendicular and
// equally long, from the centre to where the way begins and to where it is after a quarter turn.
struct Arc {
  Eigen::Vector3d center_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d start_in_world = Eigen::Vector3d::UnitX();
  Eigen::Vector3d quarter_in_world = Eigen::Vector3d::UnitY();

  [[nodiscard]] Eigen::Vector3d At(double angle_rad) const;
};

struct ArcExit {
  double angle_rad = 0.0;  // from 0 up to a whole turn; 0 where the way begins outside
  HullBoundary boundary;
};

// The first angle at which the point isn't in the hull any more; nothing if the whole circle is inside. An
// edge and its camera's centre span a plane, which the circle meets twice at most (docs/recovery.md); between
// two such meetings the label is asked of the point halfway. Held to steps of the point query by
// arc_crossings_test. Throws: PreconditionError for a circle that isn't one. Thread: any.
[[nodiscard]] std::optional<ArcExit> FirstOutside(const VisualHull& hull, const Arc& arc);
[[nodiscard]] std::optional<ArcExit> FirstOutside(const VisualHull& hull, const Arc& arc,
                                                  CrossingScratch* scratch);

}  // namespace elbowroom::recon
