// The edges of a part in a camera's picture, without what its own faces hide.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "app/control/overlay/outlined_mesh.h"
#include "app/control/overlay/view_pixels.h"
#include "core/rigid_transform.h"

namespace elbowroom::control {

// A straight piece of an edge's curve, at most a pixel long.
struct LinePiece {
  Eigen::Vector2d from_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d to_px = Eigen::Vector2d::Zero();
  double depth_mm = 0.0;                                    // of its middle
  Eigen::Vector3d middle_in_cam = Eigen::Vector3d::Zero();  // that it is seen or hidden by
};

struct PartLines {
  std::vector<LinePiece> pieces;
  std::size_t hidden = 0;  // pieces that the part's own faces hide
};

// Thread: any.
[[nodiscard]] PartLines DrawLines(const ViewPixels& view, const OutlinedMesh& part,
                                  const core::RigidTransform& cam_from_part);

}  // namespace elbowroom::control
