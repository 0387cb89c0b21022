#include "app/control/gauge/gauge_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elbowroom::control {
namespace {

using recon::BoundedMm;
using recon::CameraOfGauge;
using recon::RodSight;

std::string Beyond(const char* what, const BoundedMm& measured, double true_mm) {
  const double error_mm = measured.value_mm - true_mm;
  return fmt::format("{} is {:.2f} mm where {:.6g} mm is true: {:+.2f} mm, beyond the bound of {:.2f} mm",
                     what, measured.value_mm, true_mm, error_mm, measured.bound.total_mm());
}

void AddCamera(const CameraOfGauge& camera, std::vector<std::string>* faults) {
  switch (camera.sight) {
    case RodSight::kAstray:
      faults->push_back(fmt::format("camera '{}' sees the rod {:.1f} mm beside where the others see it",
                                    camera.name, std::abs(camera.offset->value_mm)));
      return;
    case RodSight::kRefutes:
      faults->push_back(
          fmt::format("camera '{}' sees background where the others see the rod: either its direction is "
                      "wrong, or the rod is too "
                      "small for its segmentation (min_blob_px)",
                      camera.name));
      return;
    case RodSight::kMeasured:
    case RodSight::kBlind:
      break;
  }
}

double ShareOfBound(const CameraOfGauge& camera) {
  const bool has_bound = camera.sight == RodSight::kMeasured && camera.offset;
  return has_bound ? std::abs(camera.offset->value_mm) / camera.offset->bound.total_mm() : 0.0;
}

// One line for all cameras that measure the rod and disagree: a wrong one moves the others' axis, too.
void AddOffsets(const std::vector<CameraOfGauge>& cameras, std::vector<std::string>* faults) {
  const auto worst = std::ranges::max_element(cameras, {}, ShareOfBound);
  if (ShareOfBound(*worst) <= 1.0) return;
  std::string line = fmt::format(
      "camera '{}' sees the rod {:.2f} mm beside where the others see it, beyond the bound of {:.2f} mm",
      worst->name, std::abs(worst->offset->value_mm), worst->offset->bound.total_mm());
  const auto measured = std::ranges::count(cameras, RodSight::kMeasured, &CameraOfGauge::sight);
  if (measured == 3) line += "; with three cameras it can't be told which one is wrong";
  faults->push_back(line);
}

std::string WidthsOf(const std::vector<CameraOfGauge>& cameras) {
  std::string widths;
  for (const CameraOfGauge& camera : cameras) {
    if (!camera.diameter) continue;
    widths += fmt::format("{}'{}' {:.2f} +- {:.2f} mm", widths.empty() ? "" : ", ", camera.name,
                          camera.diameter->value_mm, camera.diameter->bound.total_mm());
  }
  return widths;
}

}  // namespace

std::vector<std::string> FaultsOf(const GaugePlace& place, const TrueRod& truth) {
  const recon::RodMeasurement& rod = place.rod;
  std::vector<std::string> faults;
  if (std::abs(place.error_mm) > rod.diameter.bound.total_mm())
    faults.push_back(Beyond("the diameter", rod.diameter, truth.diameter_mm));
  if (!rod.widths_agree)
    faults.push_back("the cameras' widths of the rod have no diameter in common: " + WidthsOf(rod.cameras));
  for (const CameraOfGauge& camera : rod.cameras) AddCamera(camera, &faults);
  AddOffsets(rod.cameras, &faults);
  if (rod.straightness && rod.straightness->value_mm > rod.straightness->bound.total_mm())
    faults.push_back(fmt::format("the rod is bowed by {:.2f} mm, beyond the bound of {:.2f} mm",
                                 rod.straightness->value_mm, rod.straightness->bound.total_mm()));
  if (place.length_error_mm && std::abs(*place.length_error_mm) > rod.length->bound.total_mm())
    faults.push_back(Beyond("the length", *rod.length, *truth.length_mm));
  return faults;
}

}  // namespace elbowroom::control
