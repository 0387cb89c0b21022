#include "app/control/picking/pick.h"

#include <Eigen/Geometry>

#include "core/infinity.h"
#include "core/mesh_queries/mesh_ray.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

Vector3d OuterNormal(const core::TriangleMesh& mesh, std::uint32_t triangle) {
  const auto corner = [&](std::size_t i) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][i])];
  };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
}

}  // namespace

PickRay RayThrough(const recon::SceneView& view, const Eigen::Vector2d& pixel) {
  return {view.EyeInWorld(), (view.cam_from_world.rotation.transpose() * view.RayInCam(pixel)).normalized()};
}

std::optional<Pick> PickPart(std::span<const PickablePart> parts, const PickRay& ray, double from_mm) {
  std::optional<Pick> pick;
  for (core::PartIndex i = 0; i < parts.size(); ++i) {
    const PickablePart& part = parts[i];
    if (part.tree == nullptr) continue;
    const core::RigidTransform part_from_world = part.world_from_part.Inverse();
    // Rotations keep lengths, so distances are those in world.
    const auto met = core::FirstMet(
        *part.tree, {part_from_world * ray.origin_in_world, part_from_world.rotation * ray.direction_in_world,
                     from_mm, pick ? pick->distance_mm : core::kInfinity});
    if (!met || (pick && met->at >= pick->distance_mm)) continue;
    pick = {i, met->triangle, met->at, ray.origin_in_world + met->at * ray.direction_in_world,
            part.world_from_part.rotation * OuterNormal(part.tree->mesh(), met->triangle)};
  }
  return pick;
}

}  // namespace elbowroom::control
