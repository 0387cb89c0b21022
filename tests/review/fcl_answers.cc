#include "tests/review/fcl_answers.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <vector>

namespace elbowroom::review::testing {
namespace {

using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

void Build(const core::TriangleMesh& from, FclMesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : from.triangles)
    triangles.emplace_back(static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                           static_cast<std::size_t>(c));
  mesh.beginModel();
  mesh.addSubModel(from.vertices_mm, triangles);
  mesh.endModel();
}

fcl::Transform3d ToFcl(const core::RigidTransform& b_from_a) {
  fcl::Transform3d result = fcl::Transform3d::Identity();
  result.linear() = b_from_a.rotation;
  result.translation() = b_from_a.translation_mm;
  return result;
}

}  // namespace

FclAnswers AskFcl(const core::TriangleMesh& a, const core::RigidTransform& world_from_a,
                  const core::TriangleMesh& b, const core::RigidTransform& world_from_b) {
  FclMesh mesh_a, mesh_b;
  Build(a, mesh_a);
  Build(b, mesh_b);
  fcl::CollisionResultd collision;
  fcl::collide(&mesh_a, ToFcl(world_from_a), &mesh_b, ToFcl(world_from_b), fcl::CollisionRequestd(),
               collision);
  fcl::DistanceResultd distance;
  fcl::distance(&mesh_a, ToFcl(world_from_a), &mesh_b, ToFcl(world_from_b), fcl::DistanceRequestd(true),
                distance);
  return {collision.isCollision(), distance.min_distance, distance.nearest_points[0],
          distance.nearest_points[1]};
}

}  // namespace elbowroom::review::testing
