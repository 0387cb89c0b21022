#include "app/control/overlay/part_lines.h"

#include <algorithm>

#include "app/control/overlay/projected_edge.h"
#include "app/control/overlay/sight_line.h"

namespace elbowroom::control {

PartLines DrawLines(const ViewPixels& view, const OutlinedMesh& part,
                    const core::RigidTransform& cam_from_part) {
  PartLines lines;
  if (view.frame().isEmpty()) return lines;
  const core::RigidTransform part_from_cam = cam_from_part.Inverse();
  const Eigen::Vector3d& eye_in_part = part_from_cam.translation_mm;
  const auto in_cam = [&](std::int32_t corner) {
    return cam_from_part * part.mesh().vertices_mm[static_cast<std::size_t>(corner)];
  };
  for (const MeshEdge& edge : part.EdgesSeenFrom(eye_in_part)) {
    const std::vector<CurvePoint> curve =
        ProjectEdge(view.camera(), view.frame(), in_cam(edge.from), in_cam(edge.to));
    for (std::size_t i = 1; i < curve.size(); ++i) {
      const CurvePoint &from = curve[i - 1], &to = curve[i];
      const Eigen::Vector3d middle_in_cam = 0.5 * (from.x_in_cam + to.x_in_cam);
      if (IsHidden(part.tree(), eye_in_part, part_from_cam * middle_in_cam,
                   kOverlayNearMm / middle_in_cam.z())) {
        ++lines.hidden;
      } else {
        lines.pieces.push_back({from.pixel, to.pixel, middle_in_cam.z(), middle_in_cam});
      }
    }
  }
  return lines;
}

}  // namespace elbowroom::control
