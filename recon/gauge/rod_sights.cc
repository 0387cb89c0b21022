#include "recon/gauge/rod_sights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "recon/gauge/rod_ends.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

double LimitPx(const RodView& view, const BoundaryLimits& limits) {
  // A table of the lens is exact to 1e-5 px, and a simulated picture to 1e-4.
  constexpr double kRoundingPx = 1e-3;
  return view.is_ready ? limits.ready_px + kRoundingPx : limits.segmented_bias_px + limits.segmented_noise_px;
}

void AddSide(const RodView& view, int camera, const StraightRun& run, const Cylinder& cylinder,
             std::vector<TangentSight>* sights) {
  for (const std::uint32_t i : run.points) {
    TangentSight sight;
    sight.camera = camera;
    sight.view = &view;
    sight.point = &view.points[i];
    sight.eye_in_world = view.camera().center_in_world();
    sight.sight_in_world = view.SightInWorld(sight.point->position);
    const Vector3d across = sight.sight_in_world.cross(cylinder.axis_in_world);
    if (across.norm() < 1e-3) continue;  // along the axis
    const Eigen::Vector2d to_left(-run.along.y(), run.along.x());
    const Vector3d inward =
        view.camera().cam_from_world().rotation.transpose() * Vector3d(to_left.x(), to_left.y(), 0.0);
    sight.side = across.dot(inward) > 0.0 ? 1 : -1;
    sights->push_back(sight);
  }
}

std::vector<double> LimitsOf(const std::vector<TangentSight>& sights, const Cylinder& cylinder,
                             const BoundaryLimits& limits) {
  std::vector<double> limits_mm;
  for (const TangentSight& sight : sights)
    limits_mm.push_back(LimitPx(*sight.view, limits) * TouchOf(cylinder, sight).mm_per_px);
  return limits_mm;
}

void Refit(const BoundaryLimits& limits, FittedRod* rod) {
  rod->limits_mm = LimitsOf(rod->sights, rod->fit.cylinder, limits);
  rod->fit = FitCylinder(rod->fit.cylinder, rod->sights, rod->limits_mm);
  rod->from_mm = rod->to_mm = 0.0;
  for (const Touch& touch : rod->fit.touches) {
    rod->from_mm = std::min(rod->from_mm, touch.along_mm);
    rod->to_mm = std::max(rod->to_mm, touch.along_mm);
  }
}

// How far the sides of a rod may be used towards one of its ends, along the axis times `outward`. Near a free
// end the silhouette follows the end's rim, which leaves the side so gently that it can't be told from it;
// the sides themselves end where a half ball's would, or farther out. At an end that is held, fingers may lie
// along the side: a diameter of it isn't used.
double MostAlong(const RodView& view, const RodStrip& strip, bool is_forward, double outward,
                 const FittedRod& rod) {
  constexpr double kMarginPx = 1.5, kHeldPx = 3.0;
  const Cylinder& cylinder = rod.fit.cylinder;
  const std::optional<SeenEnd> end = FreeEnd(view, strip.strip, is_forward);
  const Eigen::Vector2d at =
      end ? end->position
          : strip.strip.middle + (is_forward ? strip.strip.to : strip.strip.from) * strip.strip.along;
  double tip_mm = outward * AlongAxis(cylinder, view, at);
  if (!end) {
    for (const std::size_t i : rod.SightsOf(strip.camera))
      tip_mm = std::max(tip_mm, outward * TouchOf(cylinder, rod.sights[i]).along_mm);
  }
  const Vector3d sight = view.SightInWorld(at);
  const double sine = std::max(sight.cross(cylinder.axis_in_world).norm(), 1e-3);
  const Vector3d tip = cylinder.point_in_world + outward * tip_mm * cylinder.axis_in_world;
  const double px_mm =
      (tip - view.camera().center_in_world()).norm() / view.plane->focal_px() * (end ? end->step : 1.0);
  const double margin_mm =
      end ? cylinder.radius_mm + kMarginPx * px_mm : 2.0 * cylinder.radius_mm + kHeldPx * px_mm;
  return tip_mm - margin_mm / sine;
}

void CutEnds(const RodView& view, const RodStrip& strip, FittedRod* rod) {
  const Cylinder& cylinder = rod->fit.cylinder;
  const double middle_mm = AlongAxis(cylinder, view, strip.strip.middle);
  const double forward =
      AlongAxis(cylinder, view, strip.strip.middle + strip.strip.along) > middle_mm ? 1.0 : -1.0;
  const double most_mm[2] = {MostAlong(view, strip, false, -forward, *rod),
                             MostAlong(view, strip, true, forward, *rod)};
  std::erase_if(rod->sights, [&](const TangentSight& sight) {
    if (sight.camera != strip.camera) return false;
    const double along_mm = forward * TouchOf(cylinder, sight).along_mm;
    return along_mm > most_mm[1] || -along_mm > most_mm[0];
  });
}

}  // namespace

std::vector<std::size_t> FittedRod::SightsOf(int camera) const {
  std::vector<std::size_t> of_camera;
  for (std::size_t i = 0; i < sights.size(); ++i)
    if (sights[i].camera == camera) of_camera.push_back(i);
  return of_camera;
}

FittedRod FitRod(std::span<const RodView> views, const FoundRod& found, const BoundaryLimits& limits) {
  FittedRod rod;
  rod.fit.cylinder = found.cylinder;
  for (const RodStrip& strip : found.agreeing) {
    const RodView& view = views[static_cast<std::size_t>(strip.camera)];
    const Strip whole = WithAllPoints(view, strip.strip);
    AddSide(view, strip.camera, whole.first, found.cylinder, &rod.sights);
    AddSide(view, strip.camera, whole.second, found.cylinder, &rod.sights);
    rod.cameras.push_back(strip.camera);
  }
  Refit(limits, &rod);
  if (!rod.fit.is_found) return rod;
  for (const RodStrip& strip : found.agreeing)
    CutEnds(views[static_cast<std::size_t>(strip.camera)], strip, &rod);
  std::erase_if(rod.cameras, [&](int camera) { return rod.SightsOf(camera).empty(); });
  if (rod.cameras.size() < 2) {
    rod.fit.is_found = false;
    return rod;
  }
  Refit(limits, &rod);
  if (!rod.fit.is_found) return rod;
  // The axis' point in the middle of what is seen, so that shifts and turns are apart.
  rod.fit.cylinder.point_in_world += 0.5 * (rod.from_mm + rod.to_mm) * rod.fit.cylinder.axis_in_world;
  Refit(limits, &rod);
  return rod;
}

}  // namespace elbowroom::recon
