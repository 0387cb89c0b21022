#include "recon/head_pose/cap.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

#include "core/error.h"
#include "core/units.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector3d;

constexpr double kFarthestMarkerMm = 1000.0;

[[noreturn]] void Refuse(const CapMarker& marker, const char* what) {
  throw core::Error(core::ErrorKind::kRange, fmt::format("the cap: marker {} {}", marker.id, what));
}

// Columns: x, y, z of a frame whose z is `z` and whose y is as near to `y` as can be.
Eigen::Matrix3d AxesOf(const Vector3d& y, const Vector3d& z) {
  const Vector3d x = y.cross(z);
  core::Require(x.norm() > 1e-6 * y.norm() * z.norm() && x.allFinite(), "the two directions differ");
  Eigen::Matrix3d axes;
  axes << x.normalized(), z.cross(x).normalized(), z.normalized();
  return axes;
}

}  // namespace

void Cap::Validate() const {
  if (markers.empty()) throw core::Error(core::ErrorKind::kRange, "the cap: it has no marker");
  std::set<int> ids;
  for (const CapMarker& marker : markers) {
    if (marker.id < 0 || !ids.insert(marker.id).second) Refuse(marker, "is there twice, or below 0");
    if (!(marker.side_mm > 0.0 && marker.side_mm < kFarthestMarkerMm))
      Refuse(marker, "must have a side above 0 mm and below 1 m");
    if (!(marker.cap_from_marker.translation_mm.norm() < kFarthestMarkerMm) ||
        !core::IsRotation(marker.cap_from_marker.rotation))
      Refuse(marker, "must be less than 1 m from the cap's origin");
  }
  if (!(cap_from_head.translation_mm.norm() < kFarthestMarkerMm) || !core::IsRotation(cap_from_head.rotation))
    throw core::Error(core::ErrorKind::kRange, "the cap: the eyes must be less than 1 m from its origin");
}

std::array<Vector3d, 4> CornersInCap(const CapMarker& marker) {
  const double h = 0.5 * marker.side_mm;
  return {marker.cap_from_marker * Vector3d(-h, h, 0.0), marker.cap_from_marker * Vector3d(h, h, 0.0),
          marker.cap_from_marker * Vector3d(h, -h, 0.0), marker.cap_from_marker * Vector3d(-h, -h, 0.0)};
}

RigidTransform CapFromMarker(const Vector3d& middle_in_cap, const Vector3d& normal_in_cap,
                             const Vector3d& up_in_cap) {
  return {AxesOf(up_in_cap, normal_in_cap), middle_in_cap};
}

RigidTransform CapFromHead(const Vector3d& eyes_in_cap, const Vector3d& forward_in_cap,
                           const Vector3d& up_in_cap) {
  return {AxesOf(-up_in_cap, forward_in_cap), eyes_in_cap};
}

Cap EightSidedCap() {
  constexpr int kSides = 8;
  constexpr double kRadiusMm = 100.0, kUpwardsDeg = 15.0, kTopMm = 45.0;
  constexpr double kRingMarkerMm = 50.0, kTopMarkerMm = 100.0;
  Cap cap{.name = "eight-sided cap", .dictionary = "DICT_4X4_50", .markers = {}, .cap_from_head = {}};
  const double upwards_rad = core::RadiansFromDegrees(kUpwardsDeg);
  for (int side = 0; side < kSides; ++side) {
    // The first one looks forward, and the numbers run to the left, as seen from above.
    const double azimuth_rad = std::numbers::pi * (0.5 + 2.0 * side / kSides);
    const Vector3d outwards(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
    const Vector3d normal = std::cos(upwards_rad) * outwards + std::sin(upwards_rad) * Vector3d::UnitZ();
    cap.markers.push_back(
        {side, kRingMarkerMm, CapFromMarker(kRadiusMm * outwards, normal, Vector3d::UnitZ())});
  }
  cap.markers.push_back(
      {kSides, kTopMarkerMm, CapFromMarker({0.0, 0.0, kTopMm}, Vector3d::UnitZ(), Vector3d::UnitY())});
  cap.cap_from_head = CapFromHead({0.0, 80.0, -90.0}, Vector3d::UnitY(), Vector3d::UnitZ());
  return cap;
}

}  // namespace elbowroom::recon
