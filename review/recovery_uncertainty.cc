#include "review/recovery_uncertainty.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "recon/hull/hull_edges.h"

namespace elbowroom::review {
namespace {

using core::Recovery;
using core::RecoveryKind;
using Eigen::Vector3d;

// Rounding of crossings and labels (docs/exact_view.md).
constexpr double kUncertaintyRoundingMm = 1e-6;
// Where V_rec is within 10 degrees of the surface (this is the sine), the first order gives no bound.
constexpr double kGrazing = 0.17;
// Another camera's surface counts as at CP_hull if its contour is this near (plus the silhouettes' error).
constexpr double kFootprintPx = 1.0;

// The silhouettes' edges that end the hull at CP_hull, the nearest first.
std::vector<recon::NearEdge> EdgesAt(const recon::VisualHull& hull, const Vector3d& cp_hull,
                                     double silhouette_px) {
  std::vector<recon::NearEdge> edges = recon::NearEdges(hull, cp_hull);
  std::ranges::sort(edges, {}, [](const auto& edge) { return edge.distance_px * edge.px_mm; });
  const auto is_far = [&](const auto& edge) { return edge.distance_px > kFootprintPx + silhouette_px; };
  std::erase_if(edges, is_far);
  return edges;
}

// The factor by which a shift of CP_obj across V_rec appears at CP_hull.
double Leverage(const Recovery& recovery, const RecoveryWay& way) {
  if (way.kind != RecoveryKind::kReference) return 1.0;
  return (recovery.cp_hull_in_world_mm - way.rp_obj).norm() /
         (recovery.cp_obj_in_world_mm - way.rp_obj).norm();
}

double AngleOfWay(const Recovery& recovery, const RecoveryWay& way, double cp_obj_mm) {
  const Vector3d& cp_obj = recovery.cp_obj_in_world_mm;
  switch (way.kind) {
    case RecoveryKind::kReference:
      return std::asin(std::min(cp_obj_mm / (cp_obj - way.rp_obj).norm(), 1.0));
    case RecoveryKind::kHinge:
      return std::asin(std::min(cp_obj_mm / way.axis.cross(cp_obj - way.at_mm).norm(), 1.0));
    default:
      return 0.0;
  }
}

// The direction in which CP_obj arrives at CP_hull.
Vector3d Arriving(const Recovery& recovery, const RecoveryWay& way) {
  if (!recovery.angle_rad) return recovery.v_rec_in_world;
  return Eigen::AngleAxisd(*recovery.angle_rad, way.axis) * recovery.v_rec_in_world;
}

double AngleBetween(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

RecoveryUncertainty UncertaintyOf(const recon::VisualHull& hull, const core::PartContact& contact,
                                  const RecoveryWay& way, double silhouette_px) {
  core::Require(contact.recovery.has_value(), "a contact with a recovery");
  core::Require(silhouette_px >= 0.0 && std::isfinite(silhouette_px), "silhouettes off by so many pixels");
  const Recovery& recovery = *contact.recovery;
  RecoveryUncertainty result;
  result.cp_obj_mm =
      contact.resolution_mm + silhouette_px * recon::LargestPixelMm(hull, recovery.cp_obj_in_world_mm);
  result.v_rec_rad = AngleOfWay(recovery, way, result.cp_obj_mm);
  if (contact.recovery_status == core::RecoveryStatus::kNoExit) return result;
  const auto edges = EdgesAt(hull, recovery.cp_hull_in_world_mm, silhouette_px);
  if (edges.empty()) return result;  // a face of the workspace

  std::vector<recon::EdgeNormal> normals;
  double steepest = 1.0, shift_mm = 0.0;
  for (const recon::NearEdge& edge : edges) {
    normals.push_back(recon::NormalOf(hull, edge));
    steepest = std::min(steepest, std::abs(normals.back().in_world.dot(Arriving(recovery, way))));
    shift_mm = std::max(shift_mm, silhouette_px * edge.px_mm);
  }
  result.is_at_edge = edges.size() > 1;
  if (steepest < kGrazing) return result;
  const double across_mm = Leverage(recovery, way) * result.cp_obj_mm;
  const double slope = std::sqrt(1.0 - steepest * steepest) / steepest;
  result.cp_hull_mm = (shift_mm + across_mm) / steepest + kUncertaintyRoundingMm;
  result.d_rec_mm = shift_mm / steepest + result.cp_obj_mm + across_mm * slope + kUncertaintyRoundingMm;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double own_rad = normals[i].UncertaintyRad(silhouette_px, *result.cp_hull_mm / edges[i].px_mm);
    result.n_hull_rad = std::max(result.n_hull_rad.value_or(0.0),
                                 own_rad + AngleBetween(normals[0].in_world, normals[i].in_world));
  }
  return result;
}

}  // namespace elbowroom::review
