// Whether a part is outside of silhouettes that are made larger by a margin each.
#pragma once

#include <optional>
#include <vector>

#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "recon/error_budget/vertex_cells.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

// The hull of the larger silhouettes, without making it. The hull must outlive it. Thread: one.
class SweptMargins {
 public:
  // One margin a camera, px of its undistorted plane; infinite: the camera excludes nothing.
  SweptMargins(const VisualHull& hull, std::vector<double> margins_px);

  // Whether for each piece of the part's surface some camera sees background within `distance_mm` of it, and
  // its contour stays outside of that when it comes nearer by the margin. Certain; false: not sure. Pieces
  // are halved until they are excluded or smaller than `finest_mm`.
  [[nodiscard]] bool Exclude(const core::TriangleTree& part, const core::RigidTransform& world_from_part,
                             double distance_mm, double finest_mm);

 private:
  struct Corners;
  [[nodiscard]] bool Exclude(const core::Ball& ball_in_world);
  [[nodiscard]] bool Exclude(const Corners& triangle);
  [[nodiscard]] bool ExcludeNode(const core::TriangleTree& part, const core::RigidTransform& world_from_part,
                                 std::uint32_t at);

  const VisualHull& hull_;
  std::vector<double> margins_px_;
  std::vector<std::optional<VertexCells>> cells_;  // one a camera, once it is needed
  double distance_mm_ = 0.0;
  double finest_mm_ = 0.0;
  core::CameraIndex likely_ = 0;
};

}  // namespace elbowroom::recon
