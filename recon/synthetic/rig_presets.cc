#include "recon/synthetic/rig_presets.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/units.h"

namespace elbowroom::recon {
namespace {

using core::RadiansFromDegrees;
using Eigen::Vector3d;

struct Placement {
  std::string name;
  Vector3d eye_in_world;
  Vector3d target_in_world;
};

// What the cameras of one rig have in common.
struct Optics {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  std::vector<double> distortion;  // plumb_bob
};

double FocalPx(int size_px, double full_angle_deg) {
  return 0.5 * size_px / std::tan(0.5 * RadiansFromDegrees(full_angle_deg));
}

core::CameraModel Camera(const Placement& placement, const Optics& optics) {
  core::CameraCalibration calibration;
  calibration.name = placement.name;
  calibration.image_width_px = optics.width_px;
  calibration.image_height_px = optics.height_px;
  calibration.camera_matrix << optics.fx_px, 0.0, 0.5 * (optics.width_px - 1), 0.0, optics.fy_px,
      0.5 * (optics.height_px - 1), 0.0, 0.0, 1.0;
  calibration.distortion_coefficients = optics.distortion;
  calibration.cam_from_world = core::CamFromWorldLookingAt(placement.eye_in_world, placement.target_in_world);
  return core::CameraModel(std::move(calibration));
}

Vector3d Around(double azimuth_deg, double distance_mm, double z_mm) {
  const double azimuth_rad = RadiansFromDegrees(azimuth_deg);
  return {distance_mm * std::cos(azimuth_rad), distance_mm * std::sin(azimuth_rad), z_mm};
}

// Square pixels and a mild barrel, as an ordinary industrial lens shows after calibration.
Optics ModernOptics(int width_px, int height_px, double width_deg) {
  const double focal_px = FocalPx(width_px, width_deg);
  return {width_px, height_px, focal_px, focal_px, {-0.08, 0.02, 0.0005, -0.0004, 0.0}};
}

}  // namespace

core::Rig PaperRig() {
  constexpr double kFarthestMm = 3300.0;
  constexpr double kPixelWidthThereMm = 2.5;
  // 24 degrees span the field's 243 lines (our reading: the paper doesn't say vertical or horizontal); the
  // pixel's width at the far end gives the horizontal focal length.
  const Optics optics{720, 243, kFarthestMm / kPixelWidthThereMm, FocalPx(243, 24.0), {0, 0, 0, 0, 0}};
  core::Rig rig;
  rig.name = "paper";
  rig.workspace_mm = {Vector3d(-762.0, -609.5, 0.0), Vector3d(762.0, 609.5, 914.0)};
  const Vector3d center_in_world = rig.workspace_mm.center();
  // The overhead camera is as high as the farthest distance lets it be: to the table's corners.
  const double overhead_z_mm =
      std::sqrt(kFarthestMm * kFarthestMm - Vector3d(762.0, 609.5, 0.0).squaredNorm());
  for (const Placement& placement : {Placement{"overhead", {0.0, 0.0, overhead_z_mm}, center_in_world},
                                     Placement{"left", {-2400.0, 0.0, 457.0}, center_in_world},
                                     Placement{"diagonal", {1550.0, -1550.0, 914.0}, center_in_world}}) {
    rig.cameras.push_back(Camera(placement, optics));
  }
  rig.Validate();
  return rig;
}

core::Rig FourCameraRig() {
  const Optics optics = ModernOptics(640, 480, 50.0);
  core::Rig rig;
  rig.name = "four_modern";
  rig.workspace_mm = {Vector3d(-400.0, -400.0, 0.0), Vector3d(500.0, 400.0, 500.0)};
  for (const Placement& placement : {Placement{"overhead", {60.0, 40.0, 1500.0}, {60.0, 0.0, 0.0}},
                                     Placement{"low", Around(225.0, 1250.0, 95.0), {60.0, 0.0, 190.0}},
                                     Placement{"level", Around(310.0, 1350.0, 355.0), {60.0, 0.0, 220.0}},
                                     Placement{"high", Around(105.0, 1100.0, 950.0), {60.0, 0.0, 160.0}}}) {
    rig.cameras.push_back(Camera(placement, optics));
  }
  rig.Validate();
  return rig;
}

core::Rig EightCameraRig() {
  const Optics optics = ModernOptics(1280, 720, 60.0);
  const Vector3d target_in_world(60.0, 0.0, 190.0);
  core::Rig rig;
  rig.name = "eight_modern";
  rig.workspace_mm = {Vector3d(-400.0, -400.0, 0.0), Vector3d(500.0, 400.0, 500.0)};
  const std::array<Placement, 8> placements{{
      {"overhead", {60.0, 40.0, 1500.0}, target_in_world},
      {"low_225", Around(225.0, 1250.0, 95.0), target_in_world},
      {"level_310", Around(310.0, 1350.0, 355.0), target_in_world},
      {"low_160", Around(160.0, 1300.0, 140.0), target_in_world},
      {"level_65", Around(65.0, 1350.0, 350.0), target_in_world},
      {"low_275", Around(275.0, 1300.0, 200.0), target_in_world},
      {"high_105", Around(105.0, 1100.0, 950.0), target_in_world},
      {"high_255", Around(255.0, 1100.0, 950.0), target_in_world},
  }};
  for (const Placement& placement : placements) rig.cameras.push_back(Camera(placement, optics));
  rig.Validate();
  return rig;
}

}  // namespace elbowroom::recon
