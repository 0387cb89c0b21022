#include "recon/gauge/rod_gauge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "recon/gauge/rod_errors.h"
#include "recon/gauge/rod_search.h"
#include "recon/gauge/rod_shape.h"
#include "recon/gauge/rod_sights.h"
#include "recon/gauge/rod_widths.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

std::vector<RodView> ViewsOf(const core::Rig& rig, const UndistortedPlanes& planes,
                             std::span<const core::SoftMask> masks) {
  core::Require(planes.size() == rig.cameras.size() && masks.size() == rig.cameras.size(),
                "a gauge has a plane and a mask for each camera");
  std::vector<RodView> views;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    core::Require(masks[i].mask.width_px() == rig.cameras[i].width_px() &&
                      masks[i].mask.height_px() == rig.cameras[i].height_px(),
                  "a mask is of its camera's size");
    views.push_back(MakeRodView(planes[i], masks[i]));
  }
  return views;
}

// Whether most of the axis is in the camera's picture, and is background there.
bool Refutes(const core::CameraModel& camera, const core::BitMask& mask, const FittedRod& rod) {
  constexpr int kPoints = 41;
  int background = 0, seen = 0;
  for (int k = 0; k < kPoints; ++k) {
    const double share = 0.1 + 0.8 * k / (kPoints - 1);
    const double along_mm = rod.from_mm + share * (rod.to_mm - rod.from_mm);
    const auto pixel =
        camera.Project(rod.fit.cylinder.point_in_world + along_mm * rod.fit.cylinder.axis_in_world);
    if (!pixel) continue;
    const int x = static_cast<int>(std::lround(pixel->x())), y = static_cast<int>(std::lround(pixel->y()));
    if (x < 0 || y < 0 || x >= mask.width_px() || y >= mask.height_px()) continue;
    ++seen;
    if (!mask.At(x, y)) ++background;
  }
  return 2 * seen > kPoints && 2 * background > seen;
}

class Measurement {
 public:
  Measurement(const core::Rig& rig, std::span<const RodView> views, std::span<const core::SoftMask> masks,
              const FoundRod& found, const FittedRod& rod, const Eigen::MatrixXd& covariance,
              const BoundaryLimits& limits)
      : rig_(rig),
        views_(views),
        masks_(masks),
        found_(found),
        rod_(rod),
        limits_(limits),
        errors_(rig, covariance, rod.sights, rod.fit.touches, rod.limits_mm) {}

  [[nodiscard]] std::optional<RodMeasurement> Make() const {
    RodMeasurement result;
    std::vector<CameraWidth> widths;
    for (std::size_t i = 0; i < rig_.cameras.size(); ++i)
      result.cameras.push_back(Camera(static_cast<int>(i), &widths));
    if (widths.size() < 2) return std::nullopt;
    const CombinedWidth combined = Combined(widths);
    result.diameter = combined.diameter;
    result.widths_agree = combined.agree;
    result.position_in_world = Middle();
    result.direction_in_world = rod_.fit.cylinder.axis_in_world;
    Eigen::Index largest = 0;
    result.direction_in_world.cwiseAbs().maxCoeff(&largest);
    if (result.direction_in_world[largest] < 0.0) result.direction_in_world *= -1.0;
    result.seen_mm = rod_.to_mm - rod_.from_mm;
    result.straightness = StraightnessOf(rod_, errors_);
    result.length = LengthOf(rod_, views_, found_.agreeing, errors_, limits_);
    return result;
  }

 private:
  [[nodiscard]] Vector3d Middle() const {
    return rod_.fit.cylinder.point_in_world +
           0.5 * (rod_.from_mm + rod_.to_mm) * rod_.fit.cylinder.axis_in_world;
  }

  [[nodiscard]] CameraOfGauge Camera(int number, std::vector<CameraWidth>* widths) const {
    const auto at = static_cast<std::size_t>(number);
    CameraOfGauge camera;
    camera.name = rig_.cameras[at].name();
    camera.distance_mm = (Middle() - rig_.cameras[at].center_in_world()).norm();
    if (std::ranges::count(rod_.cameras, number) > 0) {
      if (const auto width = WidthIn(rod_, number, errors_, limits_)) {
        camera.sight = RodSight::kMeasured;
        camera.diameter = width->diameter;
        camera.excess_px = width->excess_px;
        if (rod_.cameras.size() > 2) camera.offset = OffsetOf(rod_, number, errors_);
        widths->push_back(*width);
      }
      return camera;
    }
    const auto astray = std::ranges::find(found_.astray, number, &RodStrip::camera);
    if (!Refutes(rig_.cameras[at], masks_[at].mask, rod_)) return camera;
    camera.sight = RodSight::kRefutes;
    if (astray != found_.astray.end()) {
      camera.sight = RodSight::kAstray;
      camera.offset = BoundedMm{astray->offset_mm, {}};
    }
    return camera;
  }

  const core::Rig& rig_;
  std::span<const RodView> views_;
  std::span<const core::SoftMask> masks_;
  const FoundRod& found_;
  const FittedRod& rod_;
  BoundaryLimits limits_;
  RodErrors errors_;
};

}  // namespace

bool RodMeasurement::CamerasAgree() const {
  return std::ranges::all_of(cameras, [](const CameraOfGauge& camera) {
    if (camera.sight == RodSight::kAstray || camera.sight == RodSight::kRefutes) return false;
    return !camera.offset || std::abs(camera.offset->value_mm) <= camera.offset->bound.total_mm();
  });
}

RodGaugeResult GaugeRod(const core::Rig& rig, const UndistortedPlanes& planes,
                        std::span<const core::SoftMask> masks, const Eigen::MatrixXd& covariance,
                        double true_diameter_mm, const BoundaryLimits& limits) {
  core::Require(true_diameter_mm > 0.0 && std::isfinite(true_diameter_mm), "a rod's diameter is positive");
  const std::vector<RodView> views = ViewsOf(rig, planes, masks);
  const RodSearch search = FindRod(views, rig.workspace_mm, true_diameter_mm);
  if (!search.rod) return {std::nullopt, search.reason};
  const FittedRod rod = FitRod(views, *search.rod, limits);
  constexpr const char* kOneDirection =
      "the cameras that see the rod look along one plane through it, so its distance isn't known; turn the "
      "rod";
  if (!rod.fit.is_found) return {std::nullopt, kOneDirection};
  auto measured = Measurement(rig, views, masks, *search.rod, rod, covariance, limits).Make();
  if (!measured) return {std::nullopt, "fewer than two cameras see both sides of the rod; hold it freer"};
  return {std::move(measured), ""};
}

}  // namespace elbowroom::recon
