// The hull against one written directly with OpenCV's projection; the lens's bounds against its slopes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <vector>

#include "recon/hull/visual_hull.h"
#include "tests/oracles/picture_labels.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using oracles::PictureLabels;

// Samples nearer to the boundary than this are left out: edges are straight in the picture plane, not in the
// picture, and pictures of 40 px through lenses of 100 degrees bend a pixel by some thousandths.
constexpr double kEdgeBandPx = 2e-2;
// A scan finds a fold to its step, and towards it a pixel grows until its edges are no longer straight in the
// plane; points this near to it (relative) are left out.
constexpr double kFoldBand = 0.08;

std::vector<Vector2d> DistortWithOpenCv(const core::CameraCalibration& c,
                                        const std::vector<Vector2d>& normalised) {
  std::vector<cv::Point3d> points;
  for (const Vector2d& x : normalised) points.emplace_back(x.x(), x.y(), 1.0);
  const std::vector<double> distortion =
      c.distortion_coefficients.empty() ? std::vector<double>(4, 0.0) : c.distortion_coefficients;
  std::vector<cv::Point2d> distorted;
  if (c.distortion_model == core::DistortionModel::kFisheye) {
    cv::fisheye::projectPoints(points, distorted, cv::Vec3d(), cv::Vec3d(), cv::Matx33d::eye(), distortion);
  } else {
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), cv::Matx33d::eye(), distortion, distorted);
  }
  std::vector<Vector2d> result;
  for (const cv::Point2d& x : distorted) result.emplace_back(x.x, x.y);
  return result;
}

// The first radius at which, on any of several spokes, a step outwards moves the picture inwards.
double FoldRadius(const core::CameraCalibration& c) {
  double fold = 120.0;
  constexpr int kSpokes = 16;
  constexpr double kStep = 1.004;
  for (int i = 0; i < kSpokes; ++i) {
    const double angle_rad = 2.0 * M_PI * i / kSpokes;
    const Vector2d spoke(std::cos(angle_rad), std::sin(angle_rad));
    std::vector<Vector2d> points;
    for (double radius = 1e-3; radius < fold; radius *= kStep) points.emplace_back(radius * spoke);
    const std::vector<Vector2d> images = DistortWithOpenCv(c, points);
    for (std::size_t k = 1; k < images.size(); ++k) {
      if (images[k].dot(spoke) > images[k - 1].dot(spoke)) continue;
      fold = points[k].norm();
      break;
    }
  }
  return fold;
}

// A camera as OpenCV has it, with its fold looked up once.
struct Oracle {
  Oracle(const core::CameraModel& model, const core::BitMask& mask, bool exterior_is_object)
      : camera(model),
        labels({mask, {}}, kConvention, exterior_is_object),
        outline(oracles::OutlineLabels(model.width_px(), model.height_px(), kConvention)),
        fold(FoldRadius(model.calibration())) {}

  enum class Says { kObject, kBackground, kUnseen, kTooClose };

  [[nodiscard]] Says Ask(const Vector3d& x_in_world) const {
    const core::CameraCalibration& c = camera.calibration();
    const Vector3d x = c.cam_from_world.rotation * x_in_world + c.cam_from_world.translation_mm;
    if (x.z() <= 0.0) return Says::kUnseen;
    const Vector2d normalised(x.x() / x.z(), x.y() / x.z());
    const double radius = normalised.norm();
    if (radius > fold * (1.0 + kFoldBand)) return Says::kUnseen;
    if (radius > fold * (1.0 - kFoldBand)) return Says::kTooClose;
    const Vector2d pixel = (c.camera_matrix * DistortWithOpenCv(c, {normalised})[0].homogeneous()).head<2>();
    const oracles::Vector2L at = pixel.cast<long double>();
    for (const PictureLabels* picture : {&labels, &outline}) {
      if (picture->IsObject(at, kEdgeBandPx) != picture->IsObject(at, -kEdgeBandPx)) return Says::kTooClose;
    }
    if (!outline.IsObject(at)) return Says::kUnseen;
    // The domain ends a little before the fold where off-axis terms are bounded, not known.
    if (radius > camera.max_radius()) return Says::kTooClose;
    return labels.IsObject(at) ? Says::kObject : Says::kBackground;
  }

  static constexpr auto kConvention = oracles::BoundaryConvention::kMarchingSquares;
  const core::CameraModel& camera;
  PictureLabels labels;
  PictureLabels outline;  // object: what the picture shows
  double fold;
};

// Nothing when some camera is too close to call.
std::optional<bool> ContainsByHand(const RandomScene& scene, const std::vector<Oracle>& oracles,
                                   const Vector3d& x_in_world) {
  const core::Rig& rig = *scene.rig;
  bool is_inside = rig.workspace_mm.contains(x_in_world), any_seen = false;
  for (std::size_t i = 0; i < oracles.size(); ++i) {
    const Oracle::Says says = oracles[i].Ask(x_in_world);
    if (says == Oracle::Says::kTooClose) return std::nullopt;
    any_seen = any_seen || says != Oracle::Says::kUnseen;
    if (says == Oracle::Says::kBackground) is_inside = false;
    if (says == Oracle::Says::kUnseen && rig.unseen == core::UnseenPolicy::kOutside) is_inside = false;
  }
  return is_inside && any_seen;
}

// Half of the points where some camera looks, half anywhere about the workspace.
Vector3d RandomPoint(Random* random, const core::Rig& rig) {
  if (random->Chance(0.5)) return 1.3 * random->PointIn(rig.workspace_mm);
  const int i = random->Whole(0, static_cast<int>(rig.cameras.size()) - 1);
  const core::CameraModel& camera = rig.cameras[static_cast<std::size_t>(i)];
  const Vector2d pixel(random->Uniform(-0.2, 1.2) * camera.width_px(),
                       random->Uniform(-0.2, 1.2) * camera.height_px());
  const std::optional<Vector2d> normalised = camera.NormalisedFromPixel(pixel);
  if (!normalised) return random->PointIn(rig.workspace_mm);
  const double depth_mm = random->Uniform(0.2, 1.8) * camera.center_in_world().norm();
  return camera.cam_from_world().Inverse() * Vector3d(depth_mm * normalised->homogeneous());
}

TEST(ProjectionOracle, ContainsAgreesWithOpenCv) {
  Random random(3001);
  int asked = 0, inside = 0, too_close = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    std::vector<Oracle> oracles;
    for (std::size_t i = 0; i < scene.masks.size(); ++i)
      oracles.emplace_back(scene.rig->cameras[i], scene.masks[i], ExteriorIsObject(*scene.rig));
    for (int i = 0; i < 400; ++i) {
      const Vector3d x = RandomPoint(&random, *scene.rig);
      const std::optional<bool> truth = ContainsByHand(scene, oracles, x);
      too_close += truth ? 0 : 1;
      if (!truth) continue;
      ++asked;
      inside += *truth ? 1 : 0;
      ASSERT_EQ(hull.Contains(x), *truth) << x.transpose() << " scene " << trial;
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_LT(too_close, asked / 10);
}

TEST(ProjectionOracle, NoTwoPointsOfTheDomainStretchMoreThanCertified) {
  Random random(3002);
  double tightest = 0.0;
  for (int trial = 0; trial < 300; ++trial) {
    const core::CameraModel camera = RandomCamera(&random, static_cast<LensKind>(trial % kLensKinds));
    for (int i = 0; i < 300; ++i) {
      const double radius = camera.max_radius() * std::sqrt(random.Uniform(0.0, 1.0));
      const Vector2d at = radius * Vector2d(random.Direction().head<2>().normalized());
      // A short step inwards measures the slope, a long one any chord.
      const double step = random.Chance(0.5) ? 1e-6 * radius : random.Uniform(0.0, radius);
      const Vector2d to = at + step * Vector2d(random.Direction().head<2>().normalized());
      if (to.norm() > radius || step == 0.0) continue;
      const double moved_px = (camera.PixelFromNormalised(at) - camera.PixelFromNormalised(to)).norm();
      // A chord of 1e-6 loses nine digits of the pixels' sixteen.
      constexpr double kChordRounding = 1e-7;
      const double share = moved_px / (camera.PixelStretch(radius) * (to - at).norm());
      ASSERT_LE(share, 1.0 + kChordRounding);
      tightest = std::max(tightest, share);
    }
  }
  EXPECT_GT(tightest, 0.999);  // the bound is met: no slack is hidden in it
}

struct RealLens {
  const char* name;
  int width_px, height_px;
  double focal_px;
  core::DistortionModel model;
  std::vector<double> coefficients;
};

// Calibrations of the kinds people use: their domain must cover the whole picture.
TEST(ProjectionOracle, DomainOfARealLensCoversThePicture) {
  using core::DistortionModel;
  const std::vector<RealLens> lenses = {
      {"webcam", 640, 480, 620.0, DistortionModel::kPlumbBob, {0.12, -0.28, 1e-3, -5e-4, 0.1}},
      {"wide barrel", 1280, 720, 900.0, DistortionModel::kPlumbBob, {-0.32, 0.12, 3e-4, 2e-4, -0.02}},
      {"depth camera",
       1280,
       720,
       607.0,
       DistortionModel::kRationalPolynomial,
       {0.52, -2.71, 6e-4, -3e-4, 1.55, 0.40, -2.53, 1.47}},
      {"rational, nearly cancelling",
       1920,
       1080,
       1400.0,
       DistortionModel::kRationalPolynomial,
       {10.3, -34.0, 2e-4, 1e-4, 25.0, 10.4, -33.9, 24.0}},
      {"action camera", 1920, 1080, 870.0, DistortionModel::kFisheye, {0.04, 0.015, -0.02, 0.005}},
      {"fisheye, 170 degrees", 900, 660, 400.0, DistortionModel::kFisheye, {-0.02, 0.003, -0.002, 0.0002}},
      {"telephoto", 641, 480, 15518.0, DistortionModel::kPlumbBob, {0.0, 0.0, 0.0, 0.0, 0.0}},
  };
  for (const RealLens& lens : lenses) {
    core::CameraCalibration c;
    c.name = lens.name;
    c.image_width_px = lens.width_px;
    c.image_height_px = lens.height_px;
    c.camera_matrix << lens.focal_px, 0.0, 0.5 * lens.width_px, 0.0, lens.focal_px, 0.5 * lens.height_px, 0.0,
        0.0, 1.0;
    c.distortion_model = lens.model;
    c.distortion_coefficients = lens.coefficients;
    const core::CameraModel camera(c);
    for (const double u : {-0.5, lens.width_px - 0.5}) {
      for (const double v : {-0.5, lens.height_px - 0.5})
        EXPECT_TRUE(camera.NormalisedFromPixel({u, v}).has_value()) << lens.name << ' ' << u << ' ' << v;
    }
  }
}

TEST(ProjectionOracle, PixelToRayAndBackIsExact) {
  constexpr double kRoundTripPx = 1e-6;  // the inversion is good to 1e-12 of the plane, times focal lengths
  Random random(3003);
  int back = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const core::CameraModel camera = RandomCamera(&random, static_cast<LensKind>(trial % kLensKinds));
    for (int i = 0; i < 100; ++i) {
      const Vector2d at = camera.max_radius() * std::sqrt(random.Uniform(0.0, 1.0)) *
                          Vector2d(random.Direction().head<2>().normalized());
      const std::optional<Vector2d> again = camera.NormalisedFromPixel(camera.PixelFromNormalised(at));
      // Off-axis terms may push a point of the rim beyond what the inversion covers.
      if (!again) continue;
      ++back;
      const Vector2d pixel = camera.PixelFromNormalised(at);
      ASSERT_LT((camera.PixelFromNormalised(*again) - pixel).norm(), kRoundTripPx * (1.0 + pixel.norm()));
      ASSERT_LE(again->norm(), camera.max_radius() * (1.0 + 1e-9));
    }
  }
  EXPECT_GT(back, 29'000);
}

}  // namespace
}  // namespace elbowroom::recon
