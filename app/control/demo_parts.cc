#include "app/control/demo_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

// Points round a part; a multiple of eight puts one on every corner of a rectangle.
constexpr std::int32_t kPointsPerRing = 64;

Vector3d PointOn(const ProfileRing& ring, std::int32_t i) {
  const double angle_rad = 2.0 * std::numbers::pi * i / kPointsPerRing;
  const double x = std::cos(angle_rad);
  const double y = std::sin(angle_rad);
  const double reach = ring.is_round ? 1.0 : 1.0 / std::max(std::abs(x), std::abs(y));
  return {reach * x * ring.half_x_mm, reach * y * ring.half_y_mm, ring.z_mm};
}

core::Part DemoPart(std::string name, core::TriangleMesh mesh, const Vector3d& position_in_world_mm) {
  core::Part part;
  part.name = std::move(name);
  part.mesh = std::make_shared<const core::TriangleMesh>(std::move(mesh));
  part.world_from_part.translation_mm = position_in_world_mm;
  return part;
}

}  // namespace

ProfileRing RectangleRing(double size_x_mm, double size_y_mm, double z_mm) {
  return {false, 0.5 * size_x_mm, 0.5 * size_y_mm, z_mm};
}
ProfileRing CircleRing(double radius_mm, double z_mm) { return {true, radius_mm, radius_mm, z_mm}; }

core::TriangleMesh MeshThrough(std::span<const ProfileRing> rings) {
  core::TriangleMesh mesh;
  mesh.vertices_mm.emplace_back(0.0, 0.0, rings.front().z_mm);
  for (const ProfileRing& ring : rings) {
    for (std::int32_t i = 0; i < kPointsPerRing; ++i) mesh.vertices_mm.push_back(PointOn(ring, i));
  }
  mesh.vertices_mm.emplace_back(0.0, 0.0, rings.back().z_mm);
  const auto last = static_cast<std::int32_t>(mesh.vertices_mm.size()) - 1;
  const auto ring_count = static_cast<std::int32_t>(rings.size());
  const auto at = [](std::int32_t ring, std::int32_t i) {
    return 1 + ring * kPointsPerRing + i % kPointsPerRing;
  };
  for (std::int32_t i = 0; i < kPointsPerRing; ++i) {
    mesh.triangles.push_back({0, at(0, i + 1), at(0, i)});
    for (std::int32_t ring = 0; ring + 1 < ring_count; ++ring) {
      mesh.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      mesh.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
    mesh.triangles.push_back({last, at(ring_count - 1, i), at(ring_count - 1, i + 1)});
  }
  return mesh;
}

core::TriangleMesh PmtBox() {
  constexpr double kOutletRadiusMm = 15.0;
  constexpr double kFloorZMm = kPmtHeightMm - kWellDepthMm;
  const std::array<ProfileRing, 6> profile{
      RectangleRing(kPmtSizeMm, kPmtSizeMm, 0.0), RectangleRing(kPmtSizeMm, kPmtSizeMm, kPmtHeightMm),
      CircleRing(kWellRadiusMm, kPmtHeightMm),    CircleRing(kWellRadiusMm, kFloorZMm),
      CircleRing(kOutletRadiusMm, kFloorZMm),     CircleRing(kOutletRadiusMm, kFloorZMm + kOutletHeightMm)};
  return MeshThrough(profile);
}

core::TriangleMesh PayloadA() {
  const std::array<ProfileRing, 6> profile{
      RectangleRing(320.0, 320.0, 0.0),  RectangleRing(320.0, 320.0, 10.0),
      RectangleRing(260.0, 260.0, 10.0), RectangleRing(260.0, 260.0, 110.0),
      CircleRing(70.0, 110.0),           CircleRing(70.0, 160.0)};
  return MeshThrough(profile);
}

core::TriangleMesh PayloadB() {
  const std::array<ProfileRing, 8> profile{
      RectangleRing(130.0, 300.0, 0.0),  RectangleRing(130.0, 300.0, 10.0),
      RectangleRing(110.0, 240.0, 10.0), RectangleRing(110.0, 240.0, 170.0),
      CircleRing(40.0, 170.0),           CircleRing(40.0, 200.0),
      CircleRing(25.0, 200.0),           CircleRing(25.0, 185.0)};
  return MeshThrough(profile);
}

core::Layout DemoLayout() {
  core::Layout layout;
  layout.parts.push_back(DemoPart("pmt", PmtBox(), Vector3d::Zero()));
  layout.parts.push_back(DemoPart("payload_a", PayloadA(), {0.0, 0.0, kPmtHeightMm + kGapInitialMm}));
  layout.parts.push_back(DemoPart("payload_b", PayloadB(), {-290.0, 0.0, 0.0}));
  layout.spacings.push_back({kDemoGap, "payload_a", "pmt", core::Axis::kZ, 60.0, 400.0, kGapInitialMm});
  layout.pair_rules.push_back({"payload_a", "pmt", 60.0, false});
  layout.pair_rules.push_back({"payload_b", "pmt", 20.0, false});
  layout.pair_rules.push_back({"payload_a", "payload_b", 20.0, false});
  layout.Validate();
  return layout;
}

}  // namespace elbowroom::control
