#include "core/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/lens.h"

namespace elbowroom::core {

void PrintTo(const CameraCalibration& lens, std::ostream* out) { *out << lens.name; }

namespace {

constexpr double kSamePx = 1e-9;          // double rounding on pixel positions of a few thousand
constexpr double kSameNormalised = 1e-9;  // what Undistort settles to, times the inverse slope near a fold
constexpr int kPoints = 20'000;
constexpr int kInversions = 4'000;  // slow

constexpr int kPairs = 100'000;

CameraCalibration Calibration(const std::string& name, DistortionModel model,
                              std::vector<double> coefficients) {
  CameraCalibration c;
  c.name = name;
  c.image_width_px = 644;
  c.image_height_px = 486;
  c.camera_matrix << 490.98, 0, 337.36, 0, 492.91, 229.09, 0, 0, 1;
  c.distortion_model = model;
  c.distortion_coefficients = std::move(coefficients);
  return c;
}

// Every model and coefficient count, mild and strong.
std::vector<CameraCalibration> Lenses() {
  using enum DistortionModel;
  std::vector<CameraCalibration> lenses = {
      Calibration("pinhole", kPlumbBob, {}),
      Calibration("barrel4", kPlumbBob, {-0.2, 0.05, 0.001, -0.002}),
      Calibration("cam01", kPlumbBob,
                  {-0.3757912898, 0.2230251805, -0.000445758722, -0.000244670921, -0.08690574855}),
      Calibration("folding", kPlumbBob, {-0.37, 0.0, 0.0, 0.0, 0.0}),
      Calibration("pincushion", kPlumbBob, {0.3, 0.1, -0.004, 0.003, 0.02}),
      Calibration("decentred", kPlumbBob, {-0.1, 0.02, 0.02, -0.015, 0.0}),
      Calibration("rational8", kRationalPolynomial, {1.2, -0.4, 0.0003, -0.0002, 0.01, 1.5, -0.2, 0.03}),
      Calibration("prism12", kRationalPolynomial,
                  {-0.3, 0.1, 0.001, -0.001, 0.002, 0.05, 0.01, 0.002, 0.003, -0.001, -0.002, 0.0005}),
      Calibration("denormal", kPlumbBob, {-0.2, 0.05, 1e-310, -5e-324, -3e-308}),
      Calibration("nothing_but_denormals", kPlumbBob, {1e-310, -3e-308, 5e-324, 1e-320, 2e-308}),
      Calibration("untilted14", kRationalPolynomial, {-0.2, 0.05, 0, 0, 0, 0.1, 0, 0, 0, 0, 0, 0, 0, 0}),
      Calibration("fisheye", kFisheye, {0.05, -0.01, 0.004, -0.001}),
      Calibration("fisheye_ideal", kFisheye, {}),
      Calibration("fisheye_denormal", kFisheye, {1e-310, -3e-308, 5e-324, 1e-320}),
      Calibration("fisheye_folding", kFisheye, {-0.15, 0.01, 0.0, 0.0}),
  };
  CameraCalibration wide = Calibration("fisheye_wide", kFisheye, {-0.01, 0.002, -0.0005, 0.0001});
  wide.camera_matrix.diagonal() << 200.0, 210.0, 1.0;  // sees 85 degrees to the side
  lenses.push_back(wide);
  CameraCalibration telephoto = Calibration("telephoto", kPlumbBob, {0.4, -3.0, 0.0, 0.0, 5.0});
  telephoto.camera_matrix.diagonal() << 15518.0, 15510.0, 1.0;
  lenses.push_back(telephoto);
  return lenses;
}

Eigen::Vector2d RandomInDisc(std::mt19937& random, double radius) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double r = radius * std::sqrt(unit(random)), angle_rad = 2.0 * M_PI * unit(random);
  return {r * std::cos(angle_rad), r * std::sin(angle_rad)};
}

// The oracle: OpenCV's own projection of points in the camera frame.
std::vector<cv::Point2d> OpenCvPixels(const CameraCalibration& c, const std::vector<cv::Point3d>& in_cam) {
  cv::Matx33d k;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) k(i, j) = c.camera_matrix(i, j);
  }
  std::vector<cv::Point2d> pixels;
  const cv::Vec3d zero(0, 0, 0);
  std::vector<double> d = c.distortion_coefficients;
  if (c.distortion_model == DistortionModel::kFisheye) {
    d.resize(4, 0.0);
    cv::fisheye::projectPoints(in_cam, pixels, zero, zero, k, d);
  } else {
    cv::projectPoints(in_cam, zero, zero, k, d, pixels);
  }
  return pixels;
}

class CameraModelLens : public ::testing::TestWithParam<CameraCalibration> {};
INSTANTIATE_TEST_SUITE_P(Lenses, CameraModelLens, ::testing::ValuesIn(Lenses()),
                         [](const auto& lens) { return lens.param.name; });

TEST_P(CameraModelLens, ProjectsAsOpenCvDoesWithinTheDomain) {
  const CameraModel camera(GetParam());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> depth_mm(100.0, 5000.0);
  std::vector<cv::Point3d> in_cam;
  for (int i = 0; i < kPoints; ++i) {
    const double z = depth_mm(random);
    const Eigen::Vector2d normalised = RandomInDisc(random, 0.999999 * camera.max_radius());
    in_cam.emplace_back(normalised.x() * z, normalised.y() * z, z);
  }
  const auto expected = OpenCvPixels(GetParam(), in_cam);
  double worst_px = 0.0;
  for (std::size_t i = 0; i < in_cam.size(); ++i) {
    const auto pixel = camera.ProjectInCam({in_cam[i].x, in_cam[i].y, in_cam[i].z});
    ASSERT_TRUE(pixel);
    worst_px = std::max(worst_px, (*pixel - Eigen::Vector2d(expected[i].x, expected[i].y)).norm());
  }
  EXPECT_LT(worst_px, kSamePx);
}

TEST_P(CameraModelLens, PixelAndNormalisedPointUndoEachOther) {
  const CameraModel camera(GetParam());
  std::mt19937 random(4);
  for (int i = 0; i < kInversions; ++i) {
    // Near a fold neighbours share pixels and the inverse is ill-conditioned.
    const Eigen::Vector2d normalised = RandomInDisc(random, 0.95 * camera.max_radius());
    const auto back = camera.NormalisedFromPixel(camera.PixelFromNormalised(normalised));
    ASSERT_TRUE(back) << normalised.transpose();
    ASSERT_LT((*back - normalised).norm(), kSameNormalised * std::max(1.0, normalised.norm()));
  }
}

TEST_P(CameraModelLens, APointNearbyLeadsToTheSamePlaceAsNone) {
  const CameraModel camera(GetParam());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-0.5, camera.width_px() - 0.5), v(-0.5, camera.height_px() - 0.5);
  constexpr double kRim = 1e-4;  // of the radius: nearer to a fold the inverse is ill-conditioned
  for (int i = 0; i < kInversions; ++i) {
    const Eigen::Vector2d pixel(u(random), v(random));
    const auto exact = camera.NormalisedFromPixel(pixel);
    // From the place itself, from a few pixels beside it, and from one that is no help at all.
    for (const double off : {0.0, 1e-8, 1e-2, 1e3}) {
      const Eigen::Vector2d nearby =
          exact.value_or(Eigen::Vector2d::Zero()) + off * RandomInDisc(random, 1.0);
      const auto found = camera.NormalisedFromPixel(pixel, nearby);
      ASSERT_EQ(found.has_value(), exact.has_value()) << pixel.transpose();
      if (!exact || exact->norm() > (1.0 - kRim) * camera.max_radius()) continue;
      ASSERT_LT((*found - *exact).norm(), kSameNormalised * std::max(1.0, exact->norm())) << off;
    }
  }
}

TEST_P(CameraModelLens, EveryPixelThatItSeesLeadsBackToItself) {
  const CameraModel camera(GetParam());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-0.5, camera.width_px() - 0.5), v(-0.5, camera.height_px() - 0.5);
  for (int i = 0; i < kInversions; ++i) {
    const Eigen::Vector2d pixel(u(random), v(random));
    const auto normalised = camera.NormalisedFromPixel(pixel);
    if (!normalised) continue;  // beyond the fold: the corners of a folding lens
    ASSERT_LE(normalised->norm(), camera.max_radius() * (1.0 + 1e-12));
    ASSERT_LT((camera.PixelFromNormalised(*normalised) - pixel).norm(), 1e-6);
  }
}

TEST_P(CameraModelLens, PixelStretchIsNeverExceeded) {
  const CameraModel camera(GetParam());
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < kPairs; ++i) {
    const double radius = camera.max_radius() * unit(random);
    const Eigen::Vector2d a = RandomInDisc(random, radius);
    Eigen::Vector2d b = RandomInDisc(random, radius);
    // Half of the pairs are close, where the derivative itself is tested.
    if (i % 2 == 0) b = a + (b - a) * 1e-4;
    const double distance_px = (camera.PixelFromNormalised(a) - camera.PixelFromNormalised(b)).norm();
    ASSERT_LE(distance_px, camera.PixelStretch(radius) * (a - b).norm() + kSamePx)
        << a.transpose() << " | " << b.transpose();
  }
}

TEST_P(CameraModelLens, PixelStretchIsNotWastefulAtTheCentre) {
  const CameraModel camera(GetParam());
  // Within the innermost bin the lens is its own linear part but for a few per cent of off-axis slope.
  const double focal_px = std::max(GetParam().camera_matrix(0, 0), GetParam().camera_matrix(1, 1));
  EXPECT_GE(camera.PixelStretch(0.0), focal_px);
  EXPECT_LT(camera.PixelStretch(0.0), 1.01 * focal_px);
  EXPECT_LE(camera.PixelStretch(0.0), camera.PixelStretch(camera.max_radius()));
  EXPECT_EQ(camera.PixelStretch(10.0 * camera.max_radius()), camera.PixelStretch(camera.max_radius()));
}

// Where the largest coefficients that the lens leaves out would move a position of the plane, in long double.
Eigen::Matrix<long double, 2, 1> MovedByTheLeast(const Eigen::Vector2d& at, DistortionModel model) {
  const long double k = std::nextafter(Lens::kLeastCoefficient, 0.0), x = at.x(), y = at.y();
  const long double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  if (model == DistortionModel::kFisheye) {
    const long double t2 = std::pow(std::atan(std::sqrt(r2)), 2.0L);
    const long double share = k * t2 * (1.0L + t2 * (1.0L + t2 * (1.0L + t2)));
    return {x * share, y * share};
  }
  const long double series = k * (r2 + r4 + r6);
  const long double radial = 2.0L * series / (1.0L - series);  // (1 + series) / (1 - series), less 1
  const long double prism = k * (r2 + r4);
  return {x * radial + k * (2.0L * x * y + r2 + 2.0L * x * x) + prism,
          y * radial + k * (2.0L * x * y + r2 + 2.0L * y * y) + prism};
}

TEST(Lens, LeavesOutNoCoefficientThatRoundingWouldNotHide) {
  const long double half_ulp = std::ldexp(1.0L, -54);  // of a radius, at the least
  std::mt19937 random(17);
  for (const DistortionModel model : {DistortionModel::kRationalPolynomial, DistortionModel::kFisheye}) {
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector2d at = RandomInDisc(random, Lens::kLargestRadius);
      EXPECT_LT(MovedByTheLeast(at, model).norm(), half_ulp * at.norm());
    }
  }
}

TEST(Lens, WithoutTheseCoefficientsIsTheSame) {
  const double most = std::nextafter(Lens::kLeastCoefficient, 0.0);
  const auto ideal = [](const std::vector<double>& k) {
    return Lens(DistortionModel::kPlumbBob, k, "lens").is_ideal();
  };
  EXPECT_TRUE(ideal({most, -most, most, -most, most}));
  EXPECT_FALSE(ideal({0.0, 0.0, 0.0, Lens::kLeastCoefficient, 0.0}));
  const Lens lens(DistortionModel::kPlumbBob, {-0.2, 0.05, most, 0.001, -most}, "lens"),
      without(DistortionModel::kPlumbBob, {-0.2, 0.05, 0.0, 0.001, 0.0}, "lens");
  std::mt19937 random(18);
  for (int i = 0; i < kInversions; ++i) {
    const Eigen::Vector2d at = RandomInDisc(random, 0.9);
    EXPECT_EQ(lens.Distort(at), without.Distort(at));
    EXPECT_EQ(lens.Undistort(at, 0.9), without.Undistort(at, 0.9));
  }
}

TEST(CameraModel, PixelStretchBoundsSkewedPixelsToo) {
  CameraCalibration skewed = Calibration("skewed", DistortionModel::kPlumbBob, {-0.1, 0.01, 0.001, 0.001});
  skewed.camera_matrix(0, 1) = 120.0;
  const CameraModel camera(skewed);
  std::mt19937 random(7);
  for (int i = 0; i < kPairs; ++i) {
    const Eigen::Vector2d a = RandomInDisc(random, camera.max_radius()),
                          b = RandomInDisc(random, camera.max_radius());
    const double distance_px = (camera.PixelFromNormalised(a) - camera.PixelFromNormalised(b)).norm();
    ASSERT_LE(distance_px, camera.PixelStretch(camera.max_radius()) * (a - b).norm() + kSamePx);
    ASSERT_LT((*camera.NormalisedFromPixel(camera.PixelFromNormalised(a)) - a).norm(), kSameNormalised);
  }
}

// Lenses that fold within reach: OpenCV puts points from far outside the view into the picture; they aren't
// there.
TEST(CameraModel, PointsBeyondTheFoldAreNotSeen) {
  for (const auto& calibration : Lenses()) {
    if (calibration.name != "folding" && calibration.name != "cam01") continue;
    const CameraModel camera(calibration);
    int folded_back = 0;
    for (double radius = camera.max_radius() * 1.001; radius < 8.0; radius *= 1.01) {
      for (int direction = 0; direction < 16; ++direction) {
        const double angle_rad = direction * M_PI / 8.0;
        const cv::Point3d in_cam(1000 * radius * std::cos(angle_rad), 1000 * radius * std::sin(angle_rad),
                                 1000);
        const cv::Point2d pixel = OpenCvPixels(calibration, {in_cam})[0];
        const bool in_picture =
            pixel.x >= 0 && pixel.x < camera.width_px() && pixel.y >= 0 && pixel.y < camera.height_px();
        folded_back += in_picture ? 1 : 0;
        EXPECT_EQ(camera.ProjectInCam({in_cam.x, in_cam.y, in_cam.z}), std::nullopt);
      }
    }
    EXPECT_GT(folded_back, 0) << calibration.name << " doesn't fold: the test shows nothing";
  }
}

// Radius at which the pixels of some direction stop moving outwards, by small steps; nothing up to `limit`.
std::optional<double> FoldRadius(const CameraCalibration& calibration, double limit) {
  constexpr int kDirections = 8, kSteps = 4000;
  std::optional<double> nearest;
  for (int direction = 0; direction < kDirections; ++direction) {
    const double angle_rad = direction * 2.0 * M_PI / kDirections;
    std::vector<cv::Point3d> in_cam;
    for (int i = 0; i < kSteps; ++i) {
      const double radius = limit * i / kSteps;
      in_cam.emplace_back(radius * std::cos(angle_rad), radius * std::sin(angle_rad), 1.0);
    }
    const auto pixels = OpenCvPixels(calibration, in_cam);
    for (std::size_t i = 1; i < pixels.size(); ++i) {
      const cv::Point2d step = pixels[i] - pixels[i - 1];
      if (step.x * std::cos(angle_rad) + step.y * std::sin(angle_rad) > 0.0) continue;
      nearest = std::min(nearest.value_or(limit), limit * static_cast<double>(i) / kSteps);
      break;
    }
  }
  return nearest;
}

// Real lenses among them: the polynomial of four_cameras' cam01 folds short of the picture's corners.
TEST_P(CameraModelLens, TheDomainCoversThePictureOrEndsJustBeforeTheFoldOrAtTheHorizon) {
  constexpr double kSlack = 1.005;  // the search for the fold ends in steps of 0.02 % with interval bounds
  constexpr double kHorizonRadius = 114.0;
  const CameraModel camera(GetParam());
  bool covers = true;
  for (const double u : {-0.5, camera.width_px() - 0.5}) {
    for (const double v : {-0.5, camera.height_px() - 0.5})
      covers = covers && camera.NormalisedFromPixel({u, v});
  }
  if (covers || camera.max_radius() > kHorizonRadius) return;
  const auto fold = FoldRadius(GetParam(), kSlack * camera.max_radius());
  ASSERT_TRUE(fold) << "the domain ends at " << camera.max_radius() << " for no reason";
  EXPECT_GE(*fold, camera.max_radius() * (1.0 - 1e-3));
}

TEST(CameraModel, BehindTheCameraPlaneNothingIsSeen) {
  for (const auto& calibration : Lenses()) {
    const CameraModel camera(calibration);
    EXPECT_TRUE(camera.ProjectInCam({0, 0, 1e-6}));
    EXPECT_FALSE(camera.ProjectInCam({0, 0, 0}));
    EXPECT_FALSE(camera.ProjectInCam({0, 0, -1000}));
    EXPECT_FALSE(camera.ProjectInCam({10, 10, -1000}));
    EXPECT_FALSE(camera.ProjectInCam({0, 0, std::numeric_limits<double>::quiet_NaN()}));
    EXPECT_FALSE(camera.ProjectInCam({std::numeric_limits<double>::quiet_NaN(), 0, 100}));
  }
}

TEST(CameraModel, ProjectGoesThroughThePose) {
  CameraCalibration c = Calibration("posed", DistortionModel::kPlumbBob, {});
  c.cam_from_world = CamFromWorldLookingAt({1000, 2000, 3000}, {100, 200, 300});
  const CameraModel camera(c);
  EXPECT_LT((camera.center_in_world() - Eigen::Vector3d(1000, 2000, 3000)).norm(), 1e-9);
  const auto pixel = camera.Project({100, 200, 300});
  ASSERT_TRUE(pixel);
  EXPECT_LT((*pixel - Eigen::Vector2d(337.36, 229.09)).norm(), kSamePx);
}

struct BadCamera {
  const char* expected;
  void (*spoil)(CameraCalibration&);
};

TEST(CameraModel, ValidationNamesTheCameraAndTheFault) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const BadCamera kCases[] = {
      {"image size", [](CameraCalibration& c) { c.image_width_px = 0; }},
      {"image size", [](CameraCalibration& c) { c.image_height_px = -486; }},
      {"camera_matrix", [](CameraCalibration& c) { c.camera_matrix(0, 0) = 0.0; }},
      {"camera_matrix", [](CameraCalibration& c) { c.camera_matrix(1, 1) = -400.0; }},
      {"camera_matrix", [](CameraCalibration& c) { c.camera_matrix(0, 2) = kNaN; }},
      {"camera_matrix", [](CameraCalibration& c) { c.camera_matrix(1, 0) = 0.1; }},
      {"camera_matrix", [](CameraCalibration& c) { c.camera_matrix(2, 2) = 2.0; }},
      {"camera_matrix", [](CameraCalibration& c) { c.camera_matrix.setZero(); }},
      {"rotation_cam_from_world", [](CameraCalibration& c) { c.cam_from_world.rotation *= 1.01; }},
      {"rotation_cam_from_world", [](CameraCalibration& c) { c.cam_from_world.rotation.row(0) *= -1.0; }},
      {"rotation_cam_from_world", [](CameraCalibration& c) { c.cam_from_world.rotation(0, 0) = kNaN; }},
      {"translation_cam_from_world_mm",
       [](CameraCalibration& c) { c.cam_from_world.translation_mm.y() = kNaN; }},
      {"at most 5", [](CameraCalibration& c) { c.distortion_coefficients.assign(8, 0.0); }},
      {"not 3", [](CameraCalibration& c) { c.distortion_coefficients.assign(3, 0.0); }},
      {"not a finite",
       [](CameraCalibration& c) {
         c.distortion_coefficients = {kNaN, 0, 0, 0};
       }},
      {"fisheye takes 4",
       [](CameraCalibration& c) {
         c.distortion_model = DistortionModel::kFisheye;
         c.distortion_coefficients.assign(5, 0.0);
       }},
      {"tilted",
       [](CameraCalibration& c) {
         c.distortion_model = DistortionModel::kRationalPolynomial;
         c.distortion_coefficients.assign(14, 0.01);
       }},
      {"no lens",
       [](CameraCalibration& c) {
         c.distortion_coefficients = {-1e6, 0, 0, 0};
       }},
  };
  for (const BadCamera& bad : kCases) {
    CameraCalibration c = Calibration("left eye", DistortionModel::kPlumbBob, {});
    bad.spoil(c);
    try {
      const CameraModel camera(c);
      ADD_FAILURE() << "passed: " << bad.expected;
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::kCamera);
      EXPECT_NE(message.find("left eye"), std::string::npos) << message;
      EXPECT_NE(message.find(bad.expected), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos);
    }
  }
}

TEST(DistortionModel, TextComesBackAsTheSameModel) {
  using enum DistortionModel;
  for (const auto model : {kPlumbBob, kRationalPolynomial, kFisheye})
    EXPECT_EQ(ParseDistortionModel(ToString(model)), model);
  EXPECT_EQ(ParseDistortionModel("plumb-bob"), std::nullopt);
}

}  // namespace
}  // namespace elbowroom::core
