#include "tests/accuracy/chain/chain_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <span>

#include "core/error.h"
#include "tests/core/solids.h"
#include "tests/oracles/solid_distance.h"

namespace elbowroom::accuracy {
namespace {

using core::TriangleMesh;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPlaceMm = 0.5;

TriangleMesh BoxAround(const Vector3d& size_mm) {
  return core::Transformed(core::testing::Box(size_mm), {Eigen::Matrix3d::Identity(), -0.5 * size_mm});
}

// A profile (radius, height) that begins and ends on the axis, turned about z: counter-clockwise seen with
// the axis on the left.
TriangleMesh Turned(std::span<const Vector2d> profile, int sides) {
  TriangleMesh mesh;
  const auto inner = static_cast<int>(profile.size()) - 2;  // points that aren't on the axis
  for (int side = 0; side < sides; ++side) {
    const double angle = 2.0 * std::numbers::pi * (side + 0.5) / sides;
    for (int i = 1; i <= inner; ++i) {
      const Vector2d& at = profile[static_cast<std::size_t>(i)];
      mesh.vertices_mm.emplace_back(at.x() * std::cos(angle), at.x() * std::sin(angle), at.y());
    }
  }
  const auto bottom = static_cast<std::int32_t>(mesh.vertices_mm.size()), top = bottom + 1;
  mesh.vertices_mm.emplace_back(0.0, 0.0, profile.front().y());
  mesh.vertices_mm.emplace_back(0.0, 0.0, profile.back().y());
  for (int side = 0; side < sides; ++side) {
    const std::int32_t here = side * inner, next = (side + 1) % sides * inner;
    mesh.triangles.push_back({bottom, next, here});
    for (std::int32_t i = 0; i + 1 < inner; ++i) {
      mesh.triangles.push_back({here + i, next + i, next + i + 1});
      mesh.triangles.push_back({here + i, next + i + 1, here + i + 1});
    }
    mesh.triangles.push_back({here + inner - 1, next + inner - 1, top});
  }
  return mesh;
}

TriangleMesh Cylinder() {
  constexpr double kRadiusMm = 45.0, kHalfMm = 60.0;
  const Vector2d profile[] = {{0.0, -kHalfMm}, {kRadiusMm, -kHalfMm}, {kRadiusMm, kHalfMm}, {0.0, kHalfMm}};
  return Turned(profile, 48);
}

// Square; turned in four sides.
TriangleMesh OpenBox() {
  constexpr double kHalfSideMm = 90.0, kHeightMm = 90.0, kWallMm = 4.0;
  const double outer = std::numbers::sqrt2 * kHalfSideMm,
               inner = std::numbers::sqrt2 * (kHalfSideMm - kWallMm);
  const Vector2d profile[] = {
      {0.0, -0.5 * kHeightMm},  {outer, -0.5 * kHeightMm},           {outer, 0.5 * kHeightMm},
      {inner, 0.5 * kHeightMm}, {inner, -0.5 * kHeightMm + kWallMm}, {0.0, -0.5 * kHeightMm + kWallMm}};
  return Turned(profile, 4);
}

// Comes from far away and stops where the distance is what it shall be: no step of that length can pass the
// place.
Vector3d PlaceAt(const TriangleMesh& mesh, const Eigen::Matrix3d& rotation,
                 const std::vector<recon::Solid>& solids, double distance_mm, const Vector3d& direction,
                 const Vector3d& towards) {
  constexpr double kFromMm = 600.0, kDistanceToleranceMm = 0.05;
  double away_mm = kFromMm;
  while (away_mm > 0.0) {
    const double left_mm = oracles::SolidDistanceMm(mesh, {rotation, towards + away_mm * direction}, solids,
                                                    kDistanceToleranceMm, kFromMm) -
                           distance_mm;
    if (left_mm < kPlaceMm) break;
    away_mm -= left_mm;
  }
  return towards + away_mm * direction;
}

}  // namespace

std::vector<core::SharedMesh> ChainPartMeshes() {
  std::vector<core::SharedMesh> meshes;
  for (TriangleMesh& mesh :
       std::array{BoxAround({160.0, 100.0, 40.0}), Cylinder(), BoxAround({200.0, 150.0, 2.0}), OpenBox()})
    meshes.push_back(std::make_shared<const TriangleMesh>(std::move(mesh)));
  return meshes;
}

core::Layout DrawChainLayout(const std::vector<core::SharedMesh>& meshes,
                             const std::vector<std::vector<recon::Solid>>& objects,
                             const std::vector<double>& distances_mm, recon::Random* random) {
  core::Require(objects.size() == meshes.size() && distances_mm.size() == meshes.size(), "one a part");
  core::Layout layout;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Eigen::Matrix3d rotation = random->Rotation();
    const Vector3d direction = random->Direction();
    // Towards one of the solids, so that fingers and ends are met as often as what is large.
    const auto aim = static_cast<std::size_t>(random->Whole(0, static_cast<int>(objects[i].size()) - 1));
    const Vector3d towards = recon::BoundingSphereOf(objects[i][aim]).center_in_world;
    core::Part part;
    part.name = fmt::format("part {}", i + 1);
    part.mesh = meshes[i];
    part.world_from_part = {rotation,
                            PlaceAt(*meshes[i], rotation, objects[i], distances_mm[i], direction, towards)};
    layout.parts.push_back(std::move(part));
  }
  return layout;
}

}  // namespace elbowroom::accuracy
