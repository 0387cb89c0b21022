// The cylinder through exact silhouettes, and how errors arrive in it.
#include "recon/gauge/cylinder.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <vector>

#include "recon/calibration/lens_projection.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/recon/gauge/rod_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kExactMm = 1e-6;

// The exact outline of an endless cylinder: points of the two lines in which the planes through the camera's
// centre touch it, sin(half the angle between them) = radius / distance.
class ExactOutline {
 public:
  ExactOutline(const core::Rig& rig, const Cylinder& truth, double half_mm) {
    const UndistortedPlanes planes = MakeUndistortedPlanes(rig);
    for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
      views_.push_back(std::make_unique<RodView>());
      views_.back()->plane = planes[c];
      AddCamera(static_cast<int>(c), truth, half_mm);
    }
    for (TangentSight& sight : sights_) {
      const auto at = static_cast<std::size_t>(sight.camera);
      sight.view = views_[at].get();
      sight.point = &views_[at]->points[points_[static_cast<std::size_t>(&sight - sights_.data())]];
    }
  }

  [[nodiscard]] const std::vector<TangentSight>& sights() const { return sights_; }

 private:
  void AddCamera(int camera, const Cylinder& truth, double half_mm) {
    RodView& view = *views_[static_cast<std::size_t>(camera)];
    const Vector3d eye = view.camera().center_in_world(), u = truth.axis_in_world;
    Vector3d to_axis = truth.point_in_world - eye;
    to_axis -= to_axis.dot(u) * u;
    const double distance = to_axis.norm(), sine = truth.radius_mm / distance;
    const Vector3d near = to_axis / distance, aside = u.cross(near);
    for (const int side : {1, -1}) {
      for (double s = -half_mm; s <= half_mm; s += half_mm / 10.0) {
        // From the axis to the touching line: back along `near` by r sin, aside by r cos.
        const Vector3d x = truth.point_in_world + s * u +
                           truth.radius_mm * (side * std::sqrt(1.0 - sine * sine) * aside - sine * near);
        const Vector3d in_cam = view.camera().cam_from_world() * x;
        ContourPoint point;
        point.position = view.plane->focal_px() * in_cam.head<2>() / in_cam.z();
        point.step_in_plane = Eigen::Vector2d(1.0, 1.0);
        TangentSight sight;
        sight.camera = camera;
        sight.eye_in_world = eye;
        sight.sight_in_world = (x - eye).normalized();
        sight.side = sight.sight_in_world.cross(u).dot(truth.point_in_world - x) > 0.0 ? 1 : -1;
        points_.push_back(view.points.size());
        view.points.push_back(point);
        sights_.push_back(sight);
      }
    }
  }

  std::vector<std::unique_ptr<RodView>> views_;
  std::vector<TangentSight> sights_;
  std::vector<std::size_t> points_;
};

TEST(FitCylinder, FindsTheTrueOneFromExactOutlines) {
  for (const core::Rig& rig : {PaperRig(), FourCameraRig(), EightCameraRig()}) {
    for (const testing::Rod& rod : testing::TwentySevenRods(rig, 0.5, 10.0, 200.0)) {
      for (const double radius_mm : {5.0, 20.0, 60.0}) {
        const Cylinder truth{rod.middle_in_world, rod.direction_in_world.normalized(), radius_mm};
        const ExactOutline outline(rig, truth, 100.0);
        Cylinder start = truth;
        start.point_in_world += 5.0 * start.axis_in_world.unitOrthogonal();
        start.axis_in_world =
            (start.axis_in_world + 0.03 * start.axis_in_world.unitOrthogonal()).normalized();
        start.radius_mm *= 1.5;
        const std::vector<double> limits(outline.sights().size(), 1.0);
        const CylinderFit fit = FitCylinder(start, outline.sights(), limits);
        ASSERT_TRUE(fit.is_found);
        EXPECT_NEAR(fit.cylinder.radius_mm, radius_mm, kExactMm);
        const Vector3d off = fit.cylinder.point_in_world - truth.point_in_world;
        EXPECT_LT(off.cross(truth.axis_in_world).norm(), 100.0 * kExactMm);  // weak where planes are close
        for (const Touch& touch : fit.touches) EXPECT_NEAR(touch.error_mm, 0.0, kExactMm);
      }
    }
  }
}

TEST(FitCylinder, MovesWithErrorsAsItsGainSays) {
  const core::Rig rig = FourCameraRig();
  const Cylinder truth{rig.workspace_mm.center(), Vector3d(0.3, 0.8, 0.5).normalized(), 10.0};
  const ExactOutline outline(rig, truth, 80.0);
  const std::vector<double> limits(outline.sights().size(), 1.0);
  const CylinderFit fit = FitCylinder(truth, outline.sights(), limits);
  const auto gain = AxisGain(fit, limits, std::vector<bool>(limits.size(), true));
  for (std::size_t i = 0; i < limits.size(); i += 13) {
    constexpr double kTurnRad = 1e-5;
    std::vector<TangentSight> moved = outline.sights();
    const Vector3d inward = fit.touches[i].inward_in_world;
    moved[i].sight_in_world = (moved[i].sight_in_world - kTurnRad * inward).normalized();
    const double error_mm = TouchOf(fit.cylinder, moved[i]).error_mm;
    const CylinderFit after = FitCylinder(truth, moved, limits);
    const Vector3d shift = after.cylinder.point_in_world - fit.cylinder.point_in_world;
    constexpr double kShare = 2e-3;  // of second order in the turn
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(shift.dot(fit.across_in_world[k]), gain(k, static_cast<Eigen::Index>(i)) * error_mm,
                  kShare * std::abs(error_mm));
      EXPECT_NEAR(after.cylinder.axis_in_world.dot(fit.across_in_world[k]),
                  gain(k + 2, static_cast<Eigen::Index>(i)) * error_mm, kShare * std::abs(error_mm) / 80.0);
    }
  }
}

// The same crossing, seen by a camera with one parameter changed.
TangentSight SeenAfter(const TangentSight& sight, int parameter, double change) {
  const core::CameraModel& before = sight.view->camera();
  const auto pixel = before.PixelFromNormalised(sight.point->position / sight.view->plane->focal_px());
  core::CameraCalibration calibration = before.calibration();
  LensParameters lens = LensParametersOf(calibration);
  if (parameter < lens.count()) {
    lens.values[parameter] += change;
    PutLens(lens, &calibration);
  } else if (parameter < lens.count() + 3) {
    const Vector3d axis = Vector3d::Unit(parameter - lens.count());
    calibration.cam_from_world.rotation =
        Eigen::AngleAxisd(change, axis).toRotationMatrix() * before.cam_from_world().rotation;
  } else {
    calibration.cam_from_world.translation_mm[parameter - lens.count() - 3] += change;
  }
  const core::CameraModel after(calibration);
  const auto normalised = after.NormalisedFromPixel(pixel).value();
  TangentSight seen = sight;
  seen.eye_in_world = after.center_in_world();
  seen.sight_in_world =
      (after.cam_from_world().rotation.transpose() * Vector3d(normalised.x(), normalised.y(), 1.0))
          .normalized();
  return seen;
}

TEST(ErrorByParameters, IsADifferenceQuotient) {
  const core::Rig rig = FourCameraRig();
  const Cylinder truth{rig.workspace_mm.center(), Vector3d(0.3, -0.8, 0.5).normalized(), 10.0};
  const ExactOutline outline(rig, truth, 80.0);
  for (std::size_t i = 0; i < outline.sights().size(); i += 7) {
    const TangentSight& sight = outline.sights()[i];
    const Eigen::VectorXd by = ErrorByParameters(TouchOf(truth, sight), sight);
    const int lens = LensParametersOf(sight.view->camera().calibration()).count();
    ASSERT_EQ(by.size(), lens + 7);
    EXPECT_EQ(by[by.size() - 1], 0.0);  // a still rod is seen alike at any time
    for (int p = 0; p < lens + 6; ++p) {
      const double step = p < 4 ? 1e-2 : p < lens ? 1e-5 : p < lens + 3 ? 1e-6 : 1e-3;
      const double difference = (TouchOf(truth, SeenAfter(sight, p, step)).error_mm -
                                 TouchOf(truth, SeenAfter(sight, p, -step)).error_mm) /
                                (2.0 * step);
      EXPECT_NEAR(by[p], difference, 2e-4 * std::max(1.0, std::abs(difference))) << p;
    }
  }
}

}  // namespace
}  // namespace elbowroom::recon
