// Colours from photos: on the right places, from cameras that see them, and from those alone.
#include "recon/appearance/hull_appearance.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using SharedPhoto = std::shared_ptr<const CameraTexture>;

Solid Ball(const Vector3d& center, double radius_mm, const Vector3d& color_bgr) {
  Solid solid{Sphere{radius_mm}, {}, color_bgr};
  solid.world_from_solid.translation_mm = center;
  return solid;
}

core::CameraModel Camera(const Vector3d& eye, const Vector3d& target, int width_px, int height_px,
                         double focal_px) {
  core::CameraCalibration calibration;
  calibration.name = "head";
  calibration.image_width_px = width_px;
  calibration.image_height_px = height_px;
  calibration.camera_matrix << focal_px, 0, 0.5 * width_px + 3, 0, 1.1 * focal_px, 0.5 * height_px - 2, 0, 0,
      1;
  calibration.distortion_coefficients = {-0.25, 0.06, 0.002, -0.001, 0.0};
  calibration.cam_from_world = core::CamFromWorldLookingAt(eye, target);
  return core::CameraModel(calibration);
}

SceneView ViewAt(const Vector3d& target, double azimuth_rad, double elevation_rad) {
  OrbitCamera camera;
  camera.target_in_world = target;
  camera.distance_mm = 900.0;
  camera.azimuth_rad = azimuth_rad;
  camera.elevation_rad = elevation_rad;
  return ViewFrom(camera, 320, 240);
}

SyntheticRigOptions Clean() {
  SyntheticRigOptions options;
  options.noise_sigma_levels = 0.0;
  options.flicker_share = 0.0;
  return options;
}

// A rig's perfect silhouettes of solids, and their hull.
struct Trial {
  explicit Trial(const std::vector<Solid>& solids, core::Rig cameras = FourCameraRig())
      : rig(
            std::move(cameras),
            [objects = std::vector<SyntheticObject>{{"object", solids}}](double) { return objects; },
            Clean()),
        hull(MakeVisualHull(std::make_shared<const core::Rig>(rig.rig()), rig.TrueMasks(rig.ObjectsAt(0)))) {}

  SyntheticRig rig;
  VisualHull hull;
};

Vector3d HitAt(const HullView& picture, const SceneView& view, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(view.width_px), x = pixel % width, y = pixel / width;
  const Vector2d at(static_cast<double>(x), static_cast<double>(y));
  return view.cam_from_world.Inverse() * (static_cast<double>(picture.depth_mm[pixel]) * view.RayInCam(at));
}

// OpenCV's own projection.
Vector2d Projected(const core::CameraModel& camera, const Vector3d& x_in_world) {
  const Vector3d x = camera.cam_from_world() * x_in_world;
  const Eigen::Matrix3d& k = camera.calibration().camera_matrix;
  const cv::Matx33d matrix(k(0, 0), k(0, 1), k(0, 2), k(1, 0), k(1, 1), k(1, 2), k(2, 0), k(2, 1), k(2, 2));
  std::vector<cv::Point2d> places;
  cv::projectPoints(std::vector<cv::Point3d>{{x.x(), x.y(), x.z()}}, cv::Vec3d(), cv::Vec3d(), matrix,
                    camera.calibration().distortion_coefficients, places);
  return {places[0].x, places[0].y};
}

TEST(HullAppearance, AHeadCamerasPictureLandsOnTheRightPixels) {
  const Trial trial({Ball({60, 0, 200}, 70, Vector3d::Constant(200))});
  constexpr double kLevelsPerPx = 4.0;  // of 60 px: a level is a quarter of a pixel
  const core::CameraModel head = Camera({500, -500, 500}, {60, 0, 200}, 60, 56, 150);
  cv::Mat ramps(56, 60, CV_8UC3);
  ramps.forEach<cv::Vec3b>([](cv::Vec3b& pixel, const int* at) {
    pixel = {static_cast<std::uint8_t>(4 * at[1]), static_cast<std::uint8_t>(4 * at[0]), 0};
  });
  const SceneView view = ViewAt({60, 0, 200}, -0.5, 0.6);
  const HullView picture = ViewHull(trial.hull, CameraOf(view));
  const std::vector<SharedPhoto> photos{std::make_shared<const CameraTexture>(trial.hull, head, ramps)};
  const std::vector<CameraColor> colors = ColorHull(picture, view, photos);
  int checked = 0;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (colors[i][3] == 0) continue;
    const Vector2d seen(colors[i][2] / kLevelsPerPx, colors[i][1] / kLevelsPerPx);
    constexpr double kRoundingPx = 0.13 * 1.42;  // half a level in each direction
    ASSERT_LT((seen - Projected(head, HitAt(picture, view, i))).norm(), kRoundingPx) << i;
    ++checked;
  }
  EXPECT_GT(checked, 2000);
}

TEST(HullAppearance, WhatHidesFromACameraIsNotColouredByIt) {
  const Solid near = Ball({250, 45, 200}, 40, {0, 0, 250}), far = Ball({-50, 0, 200}, 60, {0, 250, 0});
  const Trial trial({near, far});
  const Vector3d eye(900, 0, 200);  // the near ball stands before half of the far one
  const core::CameraModel head = Camera(eye, {0, 0, 200}, 400, 300, 600);
  const std::vector<SharedPhoto> photos{std::make_shared<const CameraTexture>(
      trial.hull, head, cv::Mat(300, 400, CV_8UC3, cv::Scalar(10, 20, 30)))};
  const SceneView view = ViewAt({50, 0, 200}, -0.6, 0.5);
  const HullView picture = ViewHull(trial.hull, CameraOf(view));
  const std::vector<CameraColor> colors = ColorHull(picture, view, photos);
  int hidden = 0, seen = 0, well_seen = 0;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (picture.depth_mm[i] <= 0.0F) {
      EXPECT_EQ(colors[i], CameraColor{});
      continue;
    }
    const Vector3d at = HitAt(picture, view, i);
    const Vector3d to_eye = (eye - at).normalized();
    const auto distance_to_ray = [&](const Solid& ball) {
      const Vector3d to_ball = ball.world_from_solid.translation_mm - at;
      return (to_ball - to_ball.dot(to_eye) * to_eye).norm();
    };
    const bool is_on_far = SignedDistanceMm(far, at) < 2.0;
    const double outwards = (at - far.world_from_solid.translation_mm).normalized().dot(to_eye);
    if (is_on_far && distance_to_ray(near) < 40.0) {
      EXPECT_EQ(colors[i][3], 0) << i;  // the hull contains the ball: nothing of it is seen through
      ++hidden;
    } else if (is_on_far && distance_to_ray(near) > 60.0 && outwards > 0.6) {
      well_seen += colors[i] == CameraColor{30, 20, 10, 255} ? 1 : 0;
      ++seen;
    } else if (is_on_far && outwards < -0.2) {
      EXPECT_EQ(colors[i][3], 0) << i;  // its far side
      ++hidden;
    }
  }
  EXPECT_GT(hidden, 200);
  EXPECT_GT(seen, 50);
  EXPECT_GT(well_seen, 0.95 * seen);  // the near ball's hull is larger than the ball and hides a little more
}

TEST(HullAppearance, TheRigsCamerasGiveTheSolidsTheirColours) {
  const std::vector<Solid> solids{Ball({-40, 60, 200}, 55, {230, 40, 40}),
                                  Ball({120, -60, 160}, 60, {40, 230, 40}),
                                  Ball({140, 100, 260}, 45, {40, 40, 230})};
  Trial trial(solids, EightCameraRig());
  const FrameSet frames = trial.rig.Read(0);
  std::vector<SharedPhoto> photos;
  for (std::size_t i = 0; i < frames.cameras.size(); ++i) {
    photos.push_back(std::make_shared<const CameraTexture>(trial.hull, trial.rig.rig().cameras[i],
                                                           frames.cameras[i].image_bgr));
  }
  int of_solids = 0, trusted = 0, right = 0;
  for (const double azimuth_rad : {-2.0, -0.6, 1.0, 2.6}) {
    const SceneView view = ViewAt({60, 20, 200}, azimuth_rad, 0.4);
    const HullView picture = ViewHull(trial.hull, CameraOf(view));
    const std::vector<CameraColor> colors = ColorHull(picture, view, photos);
    for (std::size_t i = 0; i < colors.size(); ++i) {
      if (picture.depth_mm[i] <= 0.0F) continue;
      const Vector3d at = HitAt(picture, view, i);
      const auto nearest = std::ranges::min_element(
          solids, {}, [&](const Solid& solid) { return std::abs(SignedDistanceMm(solid, at)); });
      constexpr double kOfTheSolidMm =
          2.0;  // beyond, the hull is larger than the solid and shows others' colours
      if (std::abs(SignedDistanceMm(*nearest, at)) > kOfTheSolidMm) continue;
      ++of_solids;
      if (colors[i][3] < 128) continue;
      ++trusted;
      // Shading scales a colour; its hue stays.
      const Vector3d seen = Vector3d(colors[i][2], colors[i][1], colors[i][0]).normalized();
      constexpr double kSameHue = 0.995;  // cosine; 6 degrees
      right += seen.dot(nearest->color_bgr.normalized()) > kSameHue ? 1 : 0;
    }
  }
  EXPECT_GT(of_solids, 5000);
  // Nearly all is seen by some of eight cameras, all but the undersides; and nearly all of it rightly.
  EXPECT_GT(trusted, 0.85 * of_solids);
  EXPECT_GT(right, 0.995 * trusted);
}

TEST(HullAppearance, WeightsFallToNothingWithoutAJump) {
  const Trial trial({Ball({250, 45, 200}, 40, {0, 0, 250}), Ball({-50, 0, 200}, 60, {0, 250, 0})});
  const core::CameraModel head = Camera({900, 0, 200}, {-50, 60, 200}, 300, 200, 600);  // cuts the balls off
  const CameraTexture photo(trial.hull, head, cv::Mat(200, 300, CV_8UC3, cv::Scalar(10, 20, 30)));
  // Along circles on the far ball's hull, in small steps; its normals are the ball's, so that only sight
  // counts.
  const Vector3d center(-50, 0, 200);
  constexpr double kStepRad = 0.001, kOutsideMm = 110.0;
  float largest_jump = 0.0F, largest = 0.0F;
  for (double height = -0.8; height <= 0.8; height += 0.1) {
    std::optional<float> last;
    Vector3d last_at = Vector3d::Zero();
    for (double angle_rad = -1.8; angle_rad < 1.8; angle_rad += kStepRad) {
      const double across = std::sqrt(1.0 - height * height);
      const Vector3d out(across * std::cos(angle_rad), across * std::sin(angle_rad), height);
      const Ray inwards{center + kOutsideMm * out, -out};
      const Vector3d at = inwards.origin_in_world - FirstInside(trial.hull, inwards).value() * out;
      const auto look = photo.Sample(at, out);
      const float weight = look ? look->weight : 0.0F;
      constexpr double kSamePlaceMm = 0.5;  // the hull's creases may lead inwards
      if (last && (at - last_at).norm() < kSamePlaceMm)
        largest_jump = std::max(largest_jump, std::abs(weight - *last));
      largest = std::max(largest, weight);
      last = weight;
      last_at = at;
    }
  }
  EXPECT_GT(largest, 0.8F);
  // A step is 0.06 mm, a sixteenth of a pixel; the feather of six pixels rises by a quarter a pixel at most.
  EXPECT_LT(largest_jump, 0.03F);
}

TEST(HullAppearance, IsTheSameOnOneThreadAndTwice) {
  Trial trial({Ball({60, 0, 200}, 70, {40, 120, 220})});
  const FrameSet frames = trial.rig.Read(0);
  const SceneView view = ViewAt({60, 0, 200}, -0.5, 0.6);
  const HullView picture = ViewHull(trial.hull, CameraOf(view));
  const auto colors = [&] {
    const std::vector<SharedPhoto> photos{
        std::make_shared<const CameraTexture>(trial.hull, trial.rig.rig().cameras[3],
                                              frames.cameras[3].image_bgr),
        std::make_shared<const CameraTexture>(trial.hull, trial.rig.rig().cameras[2],
                                              frames.cameras[2].image_bgr)};
    return ColorHull(picture, view, photos);
  };
  const std::vector<CameraColor> first = colors();
  EXPECT_EQ(first, colors());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(first, colors());
}

TEST(HullAppearance, AbsentPhotosAndEmptyHullsGiveNoColour) {
  const Trial trial({Ball({60, 0, 200}, 70, {40, 120, 220})});
  const SceneView view = ViewAt({60, 0, 200}, -0.5, 0.6);
  const HullView picture = ViewHull(trial.hull, CameraOf(view));
  for (const CameraColor& color : ColorHull(picture, view, {})) ASSERT_EQ(color, CameraColor{});
  std::vector<core::BitMask> empty(4, core::BitMask(640, 480));
  const VisualHull nothing = MakeVisualHull(trial.hull.shared_rig(), empty);
  const core::CameraModel head = Camera({900, 0, 200}, {0, 0, 200}, 300, 200, 600);
  const CameraTexture photo(nothing, head, cv::Mat(200, 300, CV_8UC3, cv::Scalar(10, 20, 30)));
  EXPECT_FALSE(photo.Sample({60, 0, 200}, {1, 0, 0}).has_value());
}

TEST(HullAppearance, WrongSizesAreBugs) {
  const Trial trial({Ball({60, 0, 200}, 70, {40, 120, 220})});
  const core::CameraModel head = Camera({900, 0, 200}, {0, 0, 200}, 300, 200, 600);
  EXPECT_THROW(CameraTexture(trial.hull, head, cv::Mat(200, 299, CV_8UC3)), core::PreconditionError);
  EXPECT_THROW(CameraTexture(trial.hull, head, cv::Mat(200, 300, CV_8UC1)), core::PreconditionError);
  SceneView view = ViewAt({60, 0, 200}, -0.5, 0.6);
  const HullView picture = ViewHull(trial.hull, CameraOf(view));
  view.width_px = 100;
  EXPECT_THROW((void)ColorHull(picture, view, {}), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
