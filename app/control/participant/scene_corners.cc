#include "app/control/participant/scene_corners.h"

#include "app/control/overlay/outlined_mesh.h"

namespace elbowroom::control {
namespace {

constexpr double kAsNearPx = 1.0;

}  // namespace

std::vector<SceneCorner> CornersOf(const FrameResult& result) {
  std::vector<SceneCorner> corners;
  if (!result.layout) return corners;
  for (core::PartIndex i = 0; i < result.layout->parts.size(); ++i) {
    const core::Part& part = result.layout->parts[i];
    if (!part.mesh || part.mesh->triangles.empty()) continue;
    if (result.response && result.response->meshes_in_world[i]) continue;
    const OutlinedMesh outline(part.mesh);
    std::vector<bool> is_corner(part.mesh->vertices_mm.size(), false);
    for (const MeshEdge& edge : outline.edges())
      if (edge.is_sharp)
        is_corner[static_cast<std::size_t>(edge.from)] = is_corner[static_cast<std::size_t>(edge.to)] = true;
    for (std::size_t v = 0; v < is_corner.size(); ++v)
      if (is_corner[v])
        corners.push_back({part.name, result.world_from_parts[i] * part.mesh->vertices_mm[v]});
  }
  return corners;
}

std::optional<SceneCorner> CornerAt(const std::vector<SceneCorner>& corners, const recon::HeadCamera& camera,
                                    const core::RigidTransform& world_from_head, const Eigen::Vector2d& pixel,
                                    double most_px) {
  const core::RigidTransform head_from_world = world_from_head.Inverse();
  const core::RigidTransform cam_from_world = camera.head_from_camera.Inverse() * head_from_world;
  const SceneCorner* nearest = nullptr;
  double nearest_px = most_px, depth_mm = 0.0;
  for (const SceneCorner& corner : corners) {
    const double off_px = (recon::PixelOf(camera, head_from_world * corner.x_in_world) - pixel).norm();
    if (!(off_px <= most_px)) continue;  // NaN: behind the camera
    const double its_mm = (cam_from_world * corner.x_in_world).z();
    const bool is_nearer = nearest == nullptr || off_px < nearest_px - kAsNearPx ||
                           (off_px < nearest_px + kAsNearPx && its_mm < depth_mm);
    if (!is_nearer) continue;
    nearest = &corner;
    nearest_px = off_px;
    depth_mm = its_mm;
  }
  return nearest == nullptr ? std::nullopt : std::optional(*nearest);
}

}  // namespace elbowroom::control
