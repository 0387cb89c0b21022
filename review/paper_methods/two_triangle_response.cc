#include "review/paper_methods/two_triangle_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

constexpr double kNoLengthMm = 1e-9;

// The triangle's axis or one of its sides. At(share) is the point at that share of the height from the apex.
struct Line {
  Vector3d apex, to_base;
  [[nodiscard]] Vector3d At(double share) const { return apex + share * to_base; }
};

// Walks `window_px` pixels along the line, from the base (or from `reach_px`, if that is nearer to the apex)
// to the apex, and returns the centre of the first in the hull. If none is, the apex, which is a contact
// point. Nothing if the pixel at the base is in the hull: the hull's boundary lies beyond the base.
std::optional<Vector3d> FirstInHull(const recon::CoverageHull& hull, const Line& line, int window_px,
                                    double reach_px = HUGE_VAL) {
  for (int pixel = window_px - 1; pixel >= 0; --pixel) {
    if (pixel + 0.5 > reach_px) continue;
    const Vector3d x_in_world = line.At((pixel + 0.5) / window_px);
    if (!hull.Contains(x_in_world)) continue;
    if (pixel == window_px - 1) return std::nullopt;
    return x_in_world;
  }
  return line.apex;
}

// A unit vector perpendicular to `unit` and to the axis along which `unit` is least.
Vector3d Across(const Vector3d& unit) {
  Eigen::Index axis = 0;
  unit.cwiseAbs().minCoeff(&axis);
  return unit.cross(Vector3d::Unit(axis)).normalized();
}

// The difference of the points where the two sides of a triangle meet the hull.
std::optional<Vector3d> Chord(const recon::CoverageHull& hull, const Vector3d& apex, const Vector3d& axis_mm,
                              const Vector3d& half_base_mm, int window_px) {
  const auto i = FirstInHull(hull, {apex, axis_mm + half_base_mm}, window_px);
  const auto j = FirstInHull(hull, {apex, axis_mm - half_base_mm}, window_px);
  if (!i || !j) return std::nullopt;
  return *j - *i;
}

std::optional<Vector3d> NormalByTwoTriangles(const recon::CoverageHull& hull, const Vector3d& apex,
                                             const Vector3d& v_rec, const TwoTriangleOptions& options) {
  const Vector3d axis_mm = options.height_mm * v_rec;
  const double half_base_mm = options.height_mm * std::tan(0.5 * options.apex_rad);
  const Vector3d across = Across(v_rec);
  const auto ij = Chord(hull, apex, axis_mm, half_base_mm * across, options.window_px);
  const auto kl = Chord(hull, apex, axis_mm, half_base_mm * v_rec.cross(across), options.window_px);
  if (!ij || !kl) return std::nullopt;
  const Vector3d normal = ij->cross(*kl);
  if (!(normal.norm() > kNoLengthMm * kNoLengthMm)) return std::nullopt;
  return normal.dot(v_rec) < 0.0 ? -normal.normalized() : normal.normalized();
}

}  // namespace

std::string_view ToString(TwoTriangleStatus status) {
  switch (status) {
    case TwoTriangleStatus::kFound:
      return "found";
    case TwoTriangleStatus::kNoContact:
      return "no contact";
    case TwoTriangleStatus::kNoDirection:
      return "no direction";
    case TwoTriangleStatus::kReferenceInsideHull:
      return "reference inside hull";
    case TwoTriangleStatus::kDeeperThanTriangle:
      break;
  }
  return "deeper than the triangle";
}

void TwoTriangleOptions::Validate() const {
  core::Require(apex_rad > 0.0 && apex_rad < 0.5 * std::numbers::pi, "a triangle's apex is an acute angle");
  core::Require(height_mm > 0.0 && std::isfinite(height_mm), "a triangle has a height");
  core::Require(window_px >= 2 && window_px <= 4096, "a response's window is 2 to 4096 pixels wide");
  core::Require(!v_rec_in_world || std::abs(v_rec_in_world->norm() - 1.0) < 1e-6, "V_rec is a unit vector");
}

TwoTriangleResponse RespondByTwoTriangles(const recon::CoverageHull& hull,
                                          std::span<const Vector3d> contacts_in_world, const Vector3d& rp_obj,
                                          const TwoTriangleOptions& options) {
  options.Validate();
  TwoTriangleResponse response;
  response.step_mm = options.height_mm / options.window_px;
  if (contacts_in_world.empty()) return response;
  const auto distance_mm = [&](const Vector3d& x) { return (x - rp_obj).norm(); };
  const Vector3d cp_obj = *std::ranges::max_element(contacts_in_world, {}, distance_mm);
  const double to_reference_mm = distance_mm(cp_obj);
  if (!options.v_rec_in_world && !(to_reference_mm > kNoLengthMm)) {
    response.status = TwoTriangleStatus::kNoDirection;
    return response;
  }
  // A given V_rec doesn't lead to RP_obj, so RP_obj needn't be outside of the hull for it.
  const Vector3d v_rec = options.v_rec_in_world.value_or((rp_obj - cp_obj) / to_reference_mm);
  if (!options.v_rec_in_world && hull.Contains(rp_obj)) {
    response.status = TwoTriangleStatus::kReferenceInsideHull;
    return response;
  }
  response.triangles = 2;
  response.pixels = static_cast<std::int64_t>(hull.cameras().size()) * options.window_px * options.window_px;
  const double reach_px = options.v_rec_in_world ? HUGE_VAL : to_reference_mm / response.step_mm;
  const auto cp_hull = FirstInHull(hull, {cp_obj, options.height_mm * v_rec}, options.window_px, reach_px);
  if (!cp_hull) {
    response.status = TwoTriangleStatus::kDeeperThanTriangle;
    return response;
  }
  core::Recovery recovery;
  recovery.cp_obj_in_world_mm = cp_obj;
  recovery.cp_hull_in_world_mm = *cp_hull;
  recovery.v_rec_in_world = v_rec;
  recovery.d_rec_mm = (*cp_hull - cp_obj).norm();
  recovery.n_hull_in_world = NormalByTwoTriangles(hull, cp_obj, v_rec, options);
  response.status = TwoTriangleStatus::kFound;
  response.recovery = recovery;
  return response;
}

}  // namespace elbowroom::review
