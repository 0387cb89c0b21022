#include "review/cloth_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

constexpr double kKgPerM2InMm2 = 1e-6;  // kg/mm^2

// The triangle's normal, with twice its area as its length.
Vector3d DoubleArea(const core::TriangleMesh& mesh, const std::array<std::int32_t, 3>& triangle) {
  const auto at = [&](std::size_t i) { return mesh.vertices_mm[static_cast<std::size_t>(triangle[i])]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

// Whether a vertex is on a side of the bounds, to a thousandth of their size.
bool IsOn(core::BoundsSide side, const Eigen::AlignedBox3d& bounds, const Vector3d& x) {
  const auto number = static_cast<int>(side);
  const Eigen::Index axis = number / 2;
  const double place = number % 2 == 0 ? bounds.min()[axis] : bounds.max()[axis];
  return std::abs(x[axis] - place) <= 1e-3 * bounds.sizes().maxCoeff();
}

// For each edge of the mesh: the far corners of its triangles, and their area together.
struct Hinge {
  std::vector<std::uint32_t> far_corners;
  double area_mm2 = 0.0;
};
using Hinges = std::map<std::pair<std::uint32_t, std::uint32_t>, Hinge>;

Hinges HingesOf(const core::TriangleMesh& mesh) {
  Hinges hinges;
  for (const auto& triangle : mesh.triangles) {
    const double area_mm2 = 0.5 * DoubleArea(mesh, triangle).norm();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = static_cast<std::uint32_t>(triangle[i]);
      const auto b = static_cast<std::uint32_t>(triangle[(i + 1) % 3]);
      Hinge& hinge = hinges[std::minmax(a, b)];
      hinge.far_corners.push_back(static_cast<std::uint32_t>(triangle[(i + 2) % 3]));
      hinge.area_mm2 += area_mm2;
    }
  }
  return hinges;
}

}  // namespace

ClothPanel::ClothPanel(const core::Part& part)
    : rule_(std::get<core::ClothRule>(part.gives_way)), rest_(part.mesh), tree_(part.mesh) {
  for (const auto& triangle : rest_->triangles) {
    if (DoubleArea(*rest_, triangle).norm() > 0.0) continue;
    throw core::Error(core::ErrorKind::kGeometry,
                      fmt::format("part '{}': a triangle of its cloth has no area; mesh it anew", part.name));
  }
  Weigh();
  Pin(part.name);
  AddSprings();
  ChooseWayOut(part);
}

void ClothPanel::ChooseWayOut(const core::Part& part) {
  const core::RecoveryRule& recovery = part.recovery;
  if (recovery.kind == core::RecoveryKind::kHinge) {
    throw core::Error(
        core::ErrorKind::kGeometry,
        fmt::format("part '{}': a cloth leaves the hull along a line, not about a hinge; make its "
                    "recovery a slider or a direction",
                    part.name));
  }
  leaves_one_way_ = recovery.kind == core::RecoveryKind::kDirection;
  if (recovery.axis_in_part) {
    v_rec_ = recovery.axis_in_part->stableNormalized();
    return;
  }
  Vector3d normal = Vector3d::Zero();
  for (const auto& triangle : rest_->triangles) normal += DoubleArea(*rest_, triangle);
  constexpr double kFacesNoWayMm2 = 1e-6;
  if (normal.norm() < kFacesNoWayMm2) {
    throw core::Error(core::ErrorKind::kGeometry,
                      fmt::format("part '{}': its cloth faces no way; give it recovery = \"slider\" and a "
                                  "recovery_axis",
                                  part.name));
  }
  v_rec_ = normal.normalized();
}

void ClothPanel::Weigh() {
  std::vector<double> mass_kg(rest_->vertices_mm.size(), 0.0);
  for (const auto& triangle : rest_->triangles) {
    const double kg =
        0.5 * DoubleArea(*rest_, triangle).norm() * rule_.mass_per_area_kg_per_m2 * kKgPerM2InMm2;
    mass_kg_ += kg;
    for (const std::int32_t vertex : triangle) mass_kg[static_cast<std::size_t>(vertex)] += kg / 3.0;
  }
  // A vertex that belongs to no triangle has no mass. It counts as pinned.
  for (const double kg : mass_kg) inverse_mass_.push_back(kg > 0.0 ? 1.0 / kg : 0.0);
}

void ClothPanel::Pin(const std::string& part) {
  const Eigen::AlignedBox3d& bounds = tree_.bounds();
  std::size_t free = 0;
  for (std::size_t i = 0; i < inverse_mass_.size(); ++i) {
    const bool is_pinned = std::ranges::any_of(
        rule_.pins, [&](core::BoundsSide side) { return IsOn(side, bounds, rest_->vertices_mm[i]); });
    if (is_pinned) inverse_mass_[i] = 0.0;
    free += inverse_mass_[i] > 0.0 ? 1 : 0;
  }
  if (free > 0) return;
  throw core::Error(core::ErrorKind::kGeometry,
                    fmt::format("part '{}': its pins hold every vertex; name fewer sides", part));
}

void ClothPanel::AddSprings() {
  const auto add = [&](std::uint32_t a, std::uint32_t b, double stiffness_n_per_m) {
    if (inverse_mass_[a] + inverse_mass_[b] <= 0.0) return;
    const double rest_mm = (rest_->vertices_mm[a] - rest_->vertices_mm[b]).norm();
    springs_.push_back({a, b, rest_mm, 1.0 / stiffness_n_per_m});
  };
  const Hinges hinges = HingesOf(*rest_);
  for (const auto& [ends, hinge] : hinges) {
    const double length_mm = (rest_->vertices_mm[ends.first] - rest_->vertices_mm[ends.second]).norm();
    add(ends.first, ends.second, rule_.stretch_stiffness_n_per_m * hinge.area_mm2 / (length_mm * length_mm));
  }
  edge_springs_ = springs_.size();
  for (const auto& [ends, hinge] : hinges) {
    if (hinge.far_corners.size() == 2 && hinge.far_corners[0] != hinge.far_corners[1])
      add(hinge.far_corners[0], hinge.far_corners[1], rule_.bending_stiffness_n_per_m);
  }
}

}  // namespace elbowroom::review
