#include "review/hull_march.h"

#include <algorithm>

#include "recon/hull/visual_hull.h"

namespace elbowroom::review {
namespace {

std::optional<double> March(const recon::VisualHull& hull, const recon::Ray& ray, double reach_mm,
                            bool until_inside, double least_step_mm) {
  for (double along_mm = 0.0; along_mm < reach_mm;) {
    const recon::PointAnswer answer = hull.Probe(ray.origin_in_world + along_mm * ray.direction_in_world);
    if (answer.is_inside == until_inside) return along_mm;
    along_mm += std::max(answer.radius_mm, least_step_mm);
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> EntryAlong(const recon::VisualHull& hull, const recon::Ray& ray, double reach_mm) {
  return March(hull, ray, reach_mm, true, kEntryStepMm);
}

std::optional<double> ExitAlong(const recon::VisualHull& hull, const recon::Ray& ray, double reach_mm) {
  return March(hull, ray, reach_mm, false, kExitStepMm);
}

}  // namespace elbowroom::review
