#include "tests/accuracy/hard/hard_errors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "recon/exact_view/hull_view.h"
#include "recon/hull/ray_crossings.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

// The patches, in order of number, whose middle is in the hull; and how deep the deepest is.
struct PatchesInHull {
  std::vector<std::size_t> patches;
  double deepest_mm = 0.0;
};

PatchesInHull AskAllPatches(const recon::VisualHull& hull, const HardCase& hard_case) {
  PatchesInHull found;
  const std::size_t triangles = hard_case.part.tree->mesh().triangles.size();
  for (std::size_t triangle = 0; triangle < triangles; ++triangle) {
    std::size_t patch = hard_case.part.patches->FirstOf(triangle);
    for (const core::SurfacePatches::Corners& corners : hard_case.part.patches->CornersOf(triangle)) {
      const Vector3d middle = hard_case.world_from_part * corners.Centre();
      if (hull.Contains(middle)) {
        found.patches.push_back(patch);
        found.deepest_mm = std::max(found.deepest_mm, hull.Probe(middle).radius_mm);
      }
      ++patch;
    }
  }
  return found;
}

}  // namespace

ContactErrors& ContactErrors::operator+=(const ContactErrors& other) {
  is_missed |= other.is_missed;
  points_outside += other.points_outside;
  missing_patches += other.missing_patches;
  extra_patches += other.extra_patches;
  return *this;
}

ContactErrors ErrorsOf(const core::PartContact& contact, const std::vector<review::TouchedPatch>& touched,
                       const recon::VisualHull& hull, const HardCase& hard_case) {
  const PatchesInHull truth = AskAllPatches(hull, hard_case);
  ContactErrors errors;
  errors.is_missed = contact.verdict != core::Verdict::kContact && truth.deepest_mm > contact.resolution_mm;
  errors.points_outside = std::ranges::count_if(contact.points, [&](const core::ContactPoint& point) {
    return !hull.Contains(point.position_in_world_mm);
  });
  if (contact.verdict != core::Verdict::kContact) return errors;
  const auto is_touched = [&](std::size_t patch) {
    return std::ranges::binary_search(touched, patch, {}, &review::TouchedPatch::patch);
  };
  errors.missing_patches =
      std::ranges::count_if(truth.patches, [&](std::size_t p) { return !is_touched(p); });
  // Each contact point, and the deepest, may add the patch that it lies on.
  const auto of_points = static_cast<std::int64_t>(contact.points.size()) + (contact.deepest ? 1 : 0);
  const auto of_middles = static_cast<std::int64_t>(truth.patches.size()) - errors.missing_patches;
  errors.extra_patches =
      std::max(static_cast<std::int64_t>(touched.size()) - of_middles - of_points, std::int64_t{0});
  return errors;
}

ClearanceErrors ErrorsOf(const core::ClearanceInterval& interval, const recon::VisualHull& hull,
                         const core::TriangleTree& tree, const core::RigidTransform& world_from_part) {
  const core::ClearanceInterval tight =
      review::FindClearance(hull, tree, world_from_part, {.tolerance_mm = kTightMm}).interval;
  ClearanceErrors errors;
  errors.bounds_hold = interval.lower_mm <= tight.upper_mm && tight.lower_mm <= interval.upper_mm;
  errors.upper_mm = std::isfinite(interval.upper_mm) ? interval.upper_mm - tight.upper_mm : 0.0;
  return errors;
}

ViewErrors ErrorsOfView(const recon::VisualHull& hull, const core::CameraModel& view, int every) {
  const recon::ViewRays rays(view);
  const recon::HullView seen = recon::ViewHull(hull, rays);
  const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
  ViewErrors errors;
  for (int y = every / 2; y < seen.height_px; y += every) {
    for (int x = every / 2; x < seen.width_px; x += every) {
      const Vector3d in_view = rays.At(x, y).homogeneous();
      const auto along_mm = recon::FirstInside(
          hull, {world_from_view.translation_mm, world_from_view.rotation * in_view.normalized()});
      const double depth_mm = static_cast<double>(
          seen.depth_mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.width_px) +
                        static_cast<std::size_t>(x)]);
      ++errors.rays;
      if (along_mm.has_value() != (depth_mm > 0.0)) ++errors.wrong;
      if (!along_mm || !(depth_mm > 0.0)) continue;
      ++errors.hits;
      const double true_mm = *along_mm / in_view.norm();
      errors.depth_share = std::max(errors.depth_share, std::abs(depth_mm - true_mm) / true_mm);
    }
  }
  return errors;
}

}  // namespace elbowroom::accuracy
