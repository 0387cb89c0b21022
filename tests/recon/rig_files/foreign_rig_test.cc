// The files of OpenCV, ROS and Kalibr, and 3 x 4 matrices, written as their programs document them.
#include "recon/rig_files/foreign_rig.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <string>

#include "tests/recon/footage/made_footage.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using core::DistortionModel;
using core::ErrorKind;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::ErrorOf;
using ::testing::HasSubstr;

ForeignRig Parsed(const std::string& text, ForeignFormat format = ForeignFormat::kOpenCv) {
  return ParseForeignRig(text, format, "it", "stem");
}
std::string Refused(const std::string& text, ForeignFormat format) {
  return ErrorOf(ErrorKind::kFormat, [&] { (void)Parsed(text, format); });
}

Matrix3d SomeMatrix() {
  Matrix3d matrix;
  matrix << 812.25, 0.0, 321.5, 0.0, 811.0, 238.125, 0.0, 0.0, 1.0;
  return matrix;
}

// As OpenCV 4's sample `calibration` writes it, in the format that `extension` names.
std::string WrittenByOpenCv(const std::string& extension) {
  cv::FileStorage storage("it" + extension, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  const Matrix3d m = SomeMatrix();
  storage << "calibration_time"
          << "Mon 03 Jun 2024 10:11:12"
          << "image_width" << 640 << "image_height" << 480 << "flags" << 0;
  storage << "camera_matrix"
          << cv::Mat_<double>({3, 3}, {m(0, 0), 0.0, m(0, 2), 0.0, m(1, 1), m(1, 2), 0.0, 0.0, 1.0});
  storage << "distortion_coefficients" << cv::Mat_<double>({5, 1}, {-0.25, 0.0625, 0.001, -0.002, 0.03});
  storage << "names"
          << "["
          << "left01.jpg"
          << "a < b"
          << "]"
          << "empty"
          << "["
          << "]";
  return storage.releaseAndGetString();
}

class OpenCvFile : public ::testing::TestWithParam<const char*> {};

TEST_P(OpenCvFile, HasSizeMatrixAndLens) {
  const std::string text = WrittenByOpenCv(GetParam());
  EXPECT_EQ(FormatOf(text, "it"), ForeignFormat::kOpenCv);
  const ForeignRig rig = Parsed(text);
  ASSERT_EQ(rig.cameras.size(), 1U) << text;
  const ForeignCamera& camera = rig.cameras.front();
  EXPECT_EQ(camera.name, "stem");
  EXPECT_EQ(camera.lens.image_width_px, 640);
  EXPECT_EQ(camera.lens.image_height_px, 480);
  EXPECT_EQ(camera.lens.camera_matrix, SomeMatrix());
  EXPECT_EQ(camera.lens.distortion_model, DistortionModel::kPlumbBob);
  EXPECT_EQ(camera.lens.distortion_coefficients, (std::vector<double>{-0.25, 0.0625, 0.001, -0.002, 0.03}));
  EXPECT_FALSE(camera.stated.has_value());
}
INSTANTIATE_TEST_SUITE_P(Formats, OpenCvFile, ::testing::Values(".yml", ".xml", ".json"));

TEST(ForeignOpenCv, ItsStereoPairIsTwoFiles) {
  const std::string m =
      "!!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 500., 0., 320., 0., 500., 240., 0., 0., "
      "1. ]\n";
  const std::string d =
      "!!opencv-matrix\n   rows: 1\n   cols: 14\n   dt: d\n   data: [ 0.1, 0., 0., 0., 0., 0., 0., "
      "0.2, 0., 0., 0., 0., 0., 0. ]\n";
  const std::string intrinsics = "%YAML:1.0\n---\nM1: " + m + "D1: " + d + "M2: " + m + "D2: " + d;
  const std::string extrinsics =
      "%YAML:1.0\n---\nR: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 1., 0., 0., 0., 0., "
      "-1., 0., 1., "
      "0. ]\nT: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n   data: [ -3.5, 0.5, 0.25 ]\n";
  const ForeignRig rig = Joined({Parsed(intrinsics), Parsed(extrinsics)});
  ASSERT_EQ(rig.cameras.size(), 2U);
  EXPECT_EQ(rig.cameras[0].stated->rotation, Matrix3d::Identity());
  EXPECT_EQ(rig.cameras[1].stated->translation, Vector3d(-3.5, 0.5, 0.25));
  EXPECT_EQ(rig.cameras[1].lens.image_width_px, 0) << "the files don't say it";
  EXPECT_EQ(rig.cameras[1].lens.distortion_model, DistortionModel::kRationalPolynomial);
  EXPECT_EQ(rig.cameras[1].lens.distortion_coefficients.size(), 12U) << "the sensor isn't tilted";
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)Joined({Parsed(extrinsics)}); }),
              HasSubstr("add the file with both lenses"));
}

// A file of camera_calibration, which has no %YAML line; the right camera of a stereo pair.
constexpr const char* kRosFile = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo/right
camera_matrix:
  rows: 3
  cols: 3
  data: [430.0, 0.0, 320.0, 0.0, 431.0, 240.0, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.36, 0.125, 0.001, 0.0, 0.0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
projection_matrix:
  rows: 3
  cols: 4
  data: [400.0, 0.0, 320.0, -40.0, 0.0, 400.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]
)";

TEST(ForeignRos, ItsPoseIsThatOfTheProjectionMatrix) {
  EXPECT_EQ(FormatOf(kRosFile, "it"), ForeignFormat::kRos);
  const ForeignRig rig = Parsed(kRosFile, ForeignFormat::kRos);
  ASSERT_EQ(rig.cameras.size(), 1U);
  const ForeignCamera& camera = rig.cameras.front();
  EXPECT_EQ(camera.name, "narrow_stereo/right");
  EXPECT_EQ(camera.lens.camera_matrix(0, 0), 430.0);
  // The camera stands 0.1 m to the right; a point at the rectified origin is 0.1 m to its left, and
  // rectifying turns that by a quarter.
  ASSERT_TRUE(camera.stated.has_value());
  EXPECT_LE((camera.stated->translation - Vector3d(0.0, 0.1, 0.0)).norm(), 1e-12);
}

std::string KalibrCamera(const std::string& name, const std::string& more,
                         const std::string& model = "radtan") {
  return fmt::format(
      "{}:\n  cam_overlaps: [0]\n  camera_model: pinhole\n  distortion_coeffs: [-0.28, 0.07, 0.0002, "
      "1.76e-05]\n  distortion_model: {}\n  intrinsics: [458.6, 457.3, 367.2, 248.4]\n  resolution: [752, "
      "480]\n  rostopic: /eye_{}/image_raw\n{}",
      name, model, name, more);
}
std::string KalibrStep(double x) {
  return fmt::format(
      "  T_cn_cnm1:\n  - [0.0, -1.0, 0.0, {}]\n  - [1.0, 0.0, 0.0, 0.0]\n  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, "
      "0.0, 0.0, 1.0]\n  timeshift_cam_imu: 0.0\n",
      x);
}

TEST(ForeignKalibr, ItsChainIsByNumberNotByAlphabet) {
  std::string text = KalibrCamera("cam0", "") + KalibrCamera("cam1", KalibrStep(1.0));
  text += KalibrCamera("cam10", KalibrStep(7.0)) + KalibrCamera("cam2", KalibrStep(2.0), "equidistant");
  EXPECT_EQ(FormatOf(text, "it"), ForeignFormat::kKalibr);
  const ForeignRig rig = Parsed(text, ForeignFormat::kKalibr);
  ASSERT_EQ(rig.cameras.size(), 4U);
  EXPECT_TRUE(rig.is_chain);
  EXPECT_EQ(rig.cameras[3].name, "cam10");
  EXPECT_EQ(rig.cameras[3].alias, "eye_cam10");
  EXPECT_EQ(rig.cameras[2].lens.distortion_model, DistortionModel::kFisheye);
  const auto cameras = CalibrationsOf(rig, {}, 1000.0);
  // x_2 = T (T x_0 + (1, 0, 0)) + (2, 0, 0) with T a quarter turn: the origin goes to (0, 1, 0) + (2, 0, 0).
  EXPECT_LE((cameras[2].cam_from_world.translation_mm - Vector3d(2000.0, 1000.0, 0.0)).norm(), 1e-9);
}

TEST(ForeignKalibr, ModelsWithoutAnEqualAreRefused) {
  EXPECT_THAT(Refused(KalibrCamera("cam0", "", "fov"), ForeignFormat::kKalibr),
              HasSubstr("'fov' has no equal"));
  std::string omni = KalibrCamera("cam0", "");
  omni.replace(omni.find("pinhole"), 7, "omni");
  EXPECT_THAT(Refused(omni, ForeignFormat::kKalibr), HasSubstr("'omni' has no equal"));
}

// K [R | t] of a random camera; K may be skewed.
SplitProjection RandomSplit(Random* random) {
  SplitProjection split;
  split.camera_matrix << random->Uniform(300.0, 3000.0), random->Uniform(-2.0, 2.0),
      random->Uniform(0.0, 1000.0), 0.0, random->Uniform(300.0, 3000.0), random->Uniform(0.0, 1000.0), 0.0,
      0.0, 1.0;
  split.cam_from_world.rotation =
      Eigen::AngleAxisd(random->Uniform(0.0, 3.0), random->Direction()).toRotationMatrix();
  split.cam_from_world.translation = random->Uniform(0.1, 5000.0) * random->Direction();
  return split;
}
Eigen::Matrix<double, 3, 4> ProjectionOf(const SplitProjection& split) {
  Eigen::Matrix<double, 3, 4> pose;
  pose << split.cam_from_world.rotation, split.cam_from_world.translation;
  return split.camera_matrix * pose;
}

// What 1,000 products of numbers up to 1e7 leave of 16 digits.
constexpr double kRounding = 1e-9;

TEST(SplitOf, FindsThePartsUpToScaleAndSign) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const SplitProjection truth = RandomSplit(&random);
    const double scale = (random.Chance(0.5) ? -1.0 : 1.0) * random.Uniform(1e-4, 1e4);
    const auto split = SplitOf(scale * ProjectionOf(truth));
    ASSERT_TRUE(split.has_value());
    EXPECT_LE((split->camera_matrix - truth.camera_matrix).norm(), kRounding * truth.camera_matrix.norm());
    EXPECT_LE((split->cam_from_world.rotation - truth.cam_from_world.rotation).norm(), kRounding);
    EXPECT_LE((split->cam_from_world.translation - truth.cam_from_world.translation).norm(),
              kRounding * truth.cam_from_world.translation.norm());
  }
  EXPECT_FALSE(SplitOf(Eigen::Matrix<double, 3, 4>::Zero()));
  Eigen::Matrix<double, 3, 4> flat = ProjectionOf(RandomSplit(&random));
  flat.row(2) = flat.row(0);
  EXPECT_FALSE(SplitOf(flat));
}

TEST(ForeignProjection, TwelveNumbersACameraWithOrWithoutNames) {
  const std::string matrix = "500 0 320 1\n0, 500, 240, 2\n[0; 0; 1; 3]\n";
  EXPECT_EQ(FormatOf(matrix, "it"), ForeignFormat::kProjection);
  const ForeignRig one = Parsed("CONTOUR\n" + matrix, ForeignFormat::kProjection);
  ASSERT_EQ(one.cameras.size(), 1U);
  EXPECT_EQ(one.cameras[0].name, "stem");
  const ForeignRig two = Parsed("# two\n" + matrix + "left " + matrix, ForeignFormat::kProjection);
  ASSERT_EQ(two.cameras.size(), 2U);
  EXPECT_EQ(two.cameras[0].name, "cam1");
  EXPECT_EQ(two.cameras[1].name, "left");
  EXPECT_EQ(two.cameras[1].lens.camera_matrix(1, 2), 240.0);
  EXPECT_THAT(Refused("1 2 3\n", ForeignFormat::kProjection), HasSubstr("12 a camera"));
  EXPECT_THAT(Refused(matrix + "5 six 7\n", ForeignFormat::kProjection), HasSubstr("line 4: 'six'"));
  EXPECT_THAT(Refused("1 1 1 1 1 1 1 1 1 1 1 1\n", ForeignFormat::kProjection), HasSubstr("no projection"));
}

TEST(ForeignRig, NamesAreTheSameButForSignsAndZeros) {
  EXPECT_TRUE(IsSameCamera("cam_0", "Cam00"));
  EXPECT_TRUE(IsSameCamera("cam01", "cam1"));
  EXPECT_FALSE(IsSameCamera("cam1", "cam10"));
  EXPECT_FALSE(IsSameCamera("cam10", "cam1"));
  EXPECT_FALSE(IsSameCamera("", "-"));
}

TEST(ForeignRig, APoseThatIsNoRotationIsRefused) {
  ForeignRig rig = Parsed(
      "%YAML:1.0\n---\ncamera_matrix: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nimage_width: 640\n"
      "image_height: 480\nR: [1, 0, 0, 0, 1, 0, 0, 0, -1]\nT: [0, 0, 1]\n");
  EXPECT_THAT(ErrorOf(ErrorKind::kCamera, [&] { (void)CalibrationsOf(rig, {}, 1.0); }),
              HasSubstr("its rotation isn't one"));
}

TEST(StorageXml, WhatIsWrongIsToldWithItsLine) {
  const auto wrong = [](const std::string& text) { return Refused(text, ForeignFormat::kOpenCv); };
  const std::string head = "<?xml version=\"1.0\"?>\n<opencv_storage>\n";
  EXPECT_THAT(wrong("<html></html>"), HasSubstr("must be <opencv_storage>"));
  EXPECT_THAT(wrong(head + "<a>1</b></opencv_storage>"), HasSubstr("line 3: </b> ends what <a> began"));
  EXPECT_THAT(wrong(head + "<a>1"), HasSubstr("<a> has no </a>"));
  EXPECT_THAT(wrong(head + "<a"), HasSubstr("a tag without a name"));
  EXPECT_THAT(wrong(head + "<a b=\"1\""), HasSubstr("has no '>'"));
  EXPECT_THAT(wrong(head + "<a>1</a>\n<a>2</a></opencv_storage>"), HasSubstr("line 4: <a> occurs twice"));
  EXPECT_THAT(wrong(head + "<a>1<b>2</b></a></opencv_storage>"), HasSubstr("beside each other"));
  EXPECT_THAT(wrong("<!DOCTYPE x>" + head), HasSubstr("document type"));
  EXPECT_THAT(wrong(head + "<a>\"open</a></opencv_storage>"), HasSubstr("a quote isn't closed"));
  std::string deep = head;
  for (int i = 0; i < 70; ++i) deep += "<a>";
  EXPECT_THAT(wrong(deep), HasSubstr("nested more than 64 deep"));
}

}  // namespace
}  // namespace elbowroom::recon
