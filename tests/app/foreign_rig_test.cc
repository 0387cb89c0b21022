// Rigs written as other programs write theirs, in every convention and unit, and what a board makes of them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>

#include "app/control/calibration/foreign_check.h"
#include "app/control/calibration/foreign_files.h"
#include "app/control/calibration/foreign_toml.h"
#include "core/error.h"
#include "tests/recon/calibration/calibration_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using core::CameraCalibration;
using core::LengthUnit;
using core::RigidTransform;
using Eigen::Vector3d;
using recon::CalibrationScene;
using recon::ForeignFormat;
using recon::RigConvention;
using ::testing::HasSubstr;

constexpr double kNoisePx = 0.3;

CalibrationScene SceneFor(ForeignFormat format, std::uint64_t seed) {
  recon::CalibrationSceneOptions options = recon::StillBoardOptions();
  options.cameras = 3;
  options.runs = 10;
  options.noise_px = kNoisePx;
  options.has_plain_lenses = format == ForeignFormat::kKalibr;  // it has no fifth coefficient
  if (seed % 2 == 1) options.board = {recon::BoardKind::kChessboard, 10, 8, 55.0, 0.0, ""};
  return recon::MakeCalibrationScene(options, seed);
}

std::string List(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += fmt::format("{}{:.17g}", text.empty() ? "" : ", ", number);
  return "[" + text + "]";
}
std::string List(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers)
    text += fmt::format("{}{:.17g}{}", text.empty() ? "" : ", ", number,
                        number == std::floor(number) ? ".0" : "");
  return "[" + text + "]";
}
std::string Rows(const Eigen::Matrix3d& m) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += (i > 0 ? ", " : "") + List(std::vector<double>{m(i, 0), m(i, 1), m(i, 2)});
  return "[" + text + "]";
}

// How the truth is to be written.
struct Written {
  RigConvention convention;
  double unit_mm = 1.0;
};

RigidTransform InFileAxes(const CameraCalibration& camera, const Written& as) {
  const RigidTransform turn{Vector3d(1.0, -1.0, -1.0).asDiagonal().toDenseMatrix(), Vector3d::Zero()};
  return as.convention.axes == RigConvention::Axes::kOpenGl ? turn * camera.cam_from_world
                                                            : camera.cam_from_world;
}
RigidTransform Stated(const RigidTransform& to_from, const Written& as) {
  RigidTransform stated =
      as.convention.pose == RigConvention::Pose::kWorldFromCam ? to_from.Inverse() : to_from;
  stated.translation_mm /= as.unit_mm;
  return stated;
}
std::vector<double> TranslationOf(const RigidTransform& stated) {
  return {stated.translation_mm.x(), stated.translation_mm.y(), stated.translation_mm.z()};
}

std::string TomlCamera(const CameraCalibration& camera, const std::string& rotation,
                       const RigidTransform& stated) {
  return fmt::format("size = [{}, {}]\nmatrix = {}\ndistortions = {}\nrotation = {}\ntranslation = {}\n{}",
                     camera.image_width_px, camera.image_height_px, Rows(camera.camera_matrix),
                     List(camera.distortion_coefficients), rotation, List(TranslationOf(stated)),
                     camera.distortion_model == core::DistortionModel::kFisheye ? "fisheye = true\n" : "");
}

recon::ForeignRig Anipose(const CalibrationScene& scene, const Written& as) {
  std::string text;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const RigidTransform stated = Stated(InFileAxes(scene.cameras[i], as), as);
    const Eigen::AngleAxisd turn(stated.rotation);
    const Vector3d vector = turn.angle() * turn.axis();
    text +=
        fmt::format("[cam_{}]\nname = \"{}\"\n", i, scene.cameras[i].name) +
        TomlCamera(scene.cameras[i], List(std::vector<double>{vector.x(), vector.y(), vector.z()}), stated);
  }
  return ParseForeignToml(text + "[metadata]\nadjusted = true\nerror = 0.4\n", "calibration.toml");
}

recon::ForeignRig Caliscope(const CalibrationScene& scene, const Written& as) {
  std::string text;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const RigidTransform stated = Stated(InFileAxes(scene.cameras[i], as), as);
    text += fmt::format("[cameras.{}]\ncam_id = {}\nrotation_count = 0\nerror = 0.4\nignore = false\n", i + 1,
                        i + 1) +
            TomlCamera(scene.cameras[i], Rows(stated.rotation), stated);
  }
  return ParseForeignToml(text, "camera_array.toml");
}

recon::ForeignRig OpenCv(const CalibrationScene& scene, const Written& as) {
  std::vector<recon::ForeignRig> files;
  for (const CameraCalibration& camera : scene.cameras) {
    const RigidTransform stated = Stated(InFileAxes(camera, as), as);
    const std::string text = fmt::format(
        "%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\ncamera_matrix: {}\ndistortion_coefficients: {}\n"
        "fisheye_model: {}\nR: {}\nT: {}\n",
        camera.image_width_px, camera.image_height_px, Rows(camera.camera_matrix),
        List(camera.distortion_coefficients),
        camera.distortion_model == core::DistortionModel::kFisheye ? 1 : 0, Rows(stated.rotation),
        List(TranslationOf(stated)));
    files.push_back(recon::ParseForeignRig(text, ForeignFormat::kOpenCv, "it", camera.name));
  }
  return recon::Joined(std::move(files));
}

recon::ForeignRig Kalibr(const CalibrationScene& scene, const Written& as) {
  std::string text;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const CameraCalibration& camera = scene.cameras[i];
    const std::vector<double>& d = camera.distortion_coefficients;
    text += fmt::format(
        "cam{}:\n  camera_model: pinhole\n  distortion_model: radtan\n  distortion_coeffs: {}\n"
        "  intrinsics: {}\n  resolution: [{}, {}]\n  rostopic: /{}/image_raw\n",
        i, List({d[0], d[1], d[2], d[3]}),
        List({camera.camera_matrix(0, 0), camera.camera_matrix(1, 1), camera.camera_matrix(0, 2),
              camera.camera_matrix(1, 2)}),
        camera.image_width_px, camera.image_height_px, camera.name);
    if (i == 0) continue;
    const RigidTransform link =
        Stated(InFileAxes(camera, as) * InFileAxes(scene.cameras[i - 1], as).Inverse(), as);
    text += "  T_cn_cnm1:\n";
    for (int row = 0; row < 3; ++row)
      text += "  - " +
              List({link.rotation(row, 0), link.rotation(row, 1), link.rotation(row, 2),
                    link.translation_mm[row]}) +
              "\n";
    text += "  - [0.0, 0.0, 0.0, 1.0]\n";
  }
  return recon::ParseForeignRig(text, ForeignFormat::kKalibr, "it", "camchain");
}

// Up to scale and sign; with rows of pixels from below, if so stated. The lens is known from elsewhere.
recon::ForeignRig Projections(const CalibrationScene& scene, const Written& as) {
  std::string text;
  double scale = -3.0;
  for (const CameraCalibration& camera : scene.cameras) {
    Eigen::Matrix<double, 3, 4> p;
    p << camera.cam_from_world.rotation, camera.cam_from_world.translation_mm / as.unit_mm;
    p = scale * camera.camera_matrix * p;
    if (as.convention.axes == RigConvention::Axes::kOpenGl)
      p.row(1) = (camera.image_height_px - 1) * p.row(2) - p.row(1);
    text += camera.name + "\n";
    for (int row = 0; row < 3; ++row)
      text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", p(row, 0), p(row, 1), p(row, 2), p(row, 3));
    scale *= -0.01;
  }
  recon::ForeignRig rig = recon::ParseForeignRig(text, ForeignFormat::kProjection, "it", "matrices");
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    rig.cameras[i].known = scene.cameras[i];
    rig.cameras[i].lens.image_width_px = scene.cameras[i].image_width_px;
    rig.cameras[i].lens.image_height_px = scene.cameras[i].image_height_px;
  }
  return rig;
}

recon::ForeignRig Write(ForeignFormat format, const CalibrationScene& scene, const Written& as) {
  switch (format) {
    case ForeignFormat::kAnipose:
      return Anipose(scene, as);
    case ForeignFormat::kCaliscope:
      return Caliscope(scene, as);
    case ForeignFormat::kKalibr:
      return Kalibr(scene, as);
    case ForeignFormat::kProjection:
      return Projections(scene, as);
    case ForeignFormat::kOpenCv:
    case ForeignFormat::kRos:
      break;
  }
  return OpenCv(scene, as);
}

MatchedRig InOrder(recon::ForeignRig rig) {
  MatchedRig matched{std::move(rig), {}};
  for (std::size_t i = 0; i < matched.rig.cameras.size(); ++i) matched.places.push_back(i);
  return matched;
}

// Centres and rotations relative to the first camera.
void ExpectTrueRig(const CalibrationScene& scene, const std::vector<CameraCalibration>& found) {
  constexpr double kRoundingMm = 1e-6;  // of numbers with 17 digits, in metres
  for (std::size_t i = 0; i < found.size(); ++i) {
    const RigidTransform truth = scene.cameras[i].cam_from_world * scene.cameras[0].cam_from_world.Inverse();
    const RigidTransform is = found[i].cam_from_world * found[0].cam_from_world.Inverse();
    EXPECT_LE((truth.translation_mm - is.translation_mm).norm(), kRoundingMm);
    EXPECT_LE((truth.rotation - is.rotation).norm(), 1e-9);
    EXPECT_LE((found[i].camera_matrix - scene.cameras[i].camera_matrix).norm(), kRoundingMm);
  }
}

class ForeignFormats : public ::testing::TestWithParam<ForeignFormat> {};

// Every convention of every format, in units that are named and one that isn't.
TEST_P(ForeignFormats, TheBoardTellsConventionUnitAndWorld) {
  constexpr double kUnitsMm[] = {1000.0, 10.0, 1.0, 25.4};
  // The noise of one coordinate, times the root of 2, and half as much again: ten sigma of a view's RMS.
  constexpr double kMostErrorPx = 1.5 * 1.4143 * kNoisePx;
  // A wrong convention turns a camera by more than a degree, which is 9 px for the shortest lens here.
  constexpr double kRefutedPx = 9.0;
  // Points of one board in three pictures: some tenths of a mm, times 10.
  constexpr double kWorldMm = 8.0;
  std::uint64_t seed = 1;
  for (const RigConvention& convention : recon::PossibleConventions(GetParam())) {
    const Written as{convention, kUnitsMm[seed % 4]};
    const CalibrationScene scene = SceneFor(GetParam(), seed++);
    const MatchedRig matched = InOrder(Write(GetParam(), scene, as));
    const FoundConvention found = FindConvention(matched, scene.input, {});
    EXPECT_EQ(ToString(found.convention), ToString(convention));
    EXPECT_EQ(found.unit_mm, as.unit_mm);
    EXPECT_LE(found.check->error_px, kMostErrorPx);
    EXPECT_NEAR(found.check->scale, 1.0, 0.01);
    for (std::size_t i = 1; i < found.tried.size(); ++i) {
      if (!found.tried[i].check) continue;
      EXPECT_GE(found.tried[i].check->error_px, kRefutedPx);
    }
    const bool is_documented = convention == recon::DocumentedConvention(GetParam());
    EXPECT_EQ(found.warnings.empty() || found.warnings[0].find("poses are") == std::string::npos,
              is_documented);
    const auto calibrations = CalibrationsIn(matched, found.convention, found.unit_mm);
    ExpectTrueRig(scene, calibrations);
    const auto file_from_board = recon::BoardInSet(scene.input, calibrations, 0);
    ASSERT_TRUE(file_from_board.has_value());
    const RigidTransform cam_from_board = calibrations[0].cam_from_world * *file_from_board;
    EXPECT_LE(
        (cam_from_board.Inverse().translation_mm - scene.cameras[0].cam_from_world.Inverse().translation_mm)
            .norm(),
        kWorldMm);
  }
}
INSTANTIATE_TEST_SUITE_P(All, ForeignFormats,
                         ::testing::Values(ForeignFormat::kOpenCv, ForeignFormat::kKalibr,
                                           ForeignFormat::kAnipose, ForeignFormat::kCaliscope,
                                           ForeignFormat::kProjection));

std::string RefusalOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const core::Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "";
}

TEST(FindConvention, AUnitWithoutANameIsScaledByTheBoard) {
  const CalibrationScene scene = SceneFor(ForeignFormat::kOpenCv, 20);
  const MatchedRig matched = InOrder(OpenCv(scene, {{}, 37.0}));
  const FoundConvention found = FindConvention(matched, scene.input, {});
  EXPECT_FALSE(found.unit.has_value());
  EXPECT_NEAR(found.unit_mm, 37.0, 0.005 * 37.0);
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_THAT(found.warnings.back(), HasSubstr("no unit with a name"));
  EXPECT_THAT(RefusalOf([&] {
                (void)FindConvention(matched, scene.input, {{}, {}, LengthUnit::kMetre});
              }),
              HasSubstr("not 1 m"));
}

TEST(FindConvention, ABoardOfAnotherSizeIsTold) {
  const CalibrationScene scene = SceneFor(ForeignFormat::kAnipose, 22);
  const FoundConvention found = FindConvention(InOrder(Anipose(scene, {{}, 1.03})), scene.input, {});
  EXPECT_EQ(found.unit, LengthUnit::kMillimetre);
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_THAT(found.warnings.back(), HasSubstr("3.0 % larger"));
}

TEST(FindConvention, WhatIsStatedIsHeldAndRefuted) {
  const CalibrationScene scene = SceneFor(ForeignFormat::kAnipose, 24);
  const Written as{{RigConvention::Pose::kWorldFromCam, RigConvention::Axes::kOpenCv}, 1.0};
  const MatchedRig matched = InOrder(Anipose(scene, as));
  EXPECT_THAT(RefusalOf([&] {
                (void)FindConvention(matched, scene.input, {RigConvention::Pose::kCamFromWorld, {}, {}});
              }),
              HasSubstr("the board refutes the poses"));
}

TEST(FindConvention, ExchangedCamerasAreRefusedWithTheFigures) {
  const CalibrationScene scene = SceneFor(ForeignFormat::kOpenCv, 26);
  MatchedRig matched = InOrder(OpenCv(scene, {}));
  std::swap(matched.rig.cameras[0].stated, matched.rig.cameras[1].stated);
  const std::string refusal = RefusalOf([&] { (void)FindConvention(matched, scene.input, {}); });
  EXPECT_THAT(refusal, HasSubstr("the board refutes the poses: camera 'cam"));
  EXPECT_THAT(refusal, HasSubstr("px off at best"));
}

// The sightings of a scene's boards by other cameras.
recon::CalibrationInput SeenBy(const CalibrationScene& scene, const std::vector<CameraCalibration>& cameras,
                               double noise_px) {
  recon::CalibrationInput input = scene.input;
  input.views.clear();
  const std::vector<Vector3d> points = recon::PointsOf(input.board);
  for (std::size_t set = 0; set < scene.world_from_board.size(); ++set) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      recon::CalibrationView view{static_cast<int>(i), static_cast<int>(set), 0.0, {}, "frame"};
      for (std::size_t k = 0; k < points.size(); ++k)
        if (const auto pixel = core::CameraModel(cameras[i]).Project(scene.world_from_board[set] * points[k]))
          view.sighting.points.push_back({static_cast<int>(k), *pixel, noise_px});
      if (view.sighting.points.size() == points.size()) input.views.push_back(std::move(view));
    }
  }
  recon::Random random(7);
  recon::AddNoise(noise_px, &random, &input);
  input.cameras.resize(cameras.size());
  return input;
}

// Two cameras side by side that look the same way: with the axes of OpenGL the rig is the same.
TEST(FindConvention, ConventionsOfTheSameRigAreNoChoice) {
  CalibrationScene scene = SceneFor(ForeignFormat::kKalibr, 28);
  std::vector<CameraCalibration> pair{scene.cameras[1], scene.cameras[1]};
  pair[1].cam_from_world.translation_mm.x() -= 120.0;
  const recon::CalibrationInput input = SeenBy(scene, pair, kNoisePx);
  scene.cameras = pair;
  const FoundConvention found = FindConvention(InOrder(Kalibr(scene, {{}, 1000.0})), input, {});
  EXPECT_EQ(found.convention, RigConvention{});
  EXPECT_EQ(found.unit, LengthUnit::kMetre);
}

// Two cameras in nearly one place, which look nearly the same way, in coarse pictures.
TEST(FindConvention, WhatTheBoardDoesNotTellIsRefused) {
  constexpr double kNearlyRad = 0.001, kCoarsePx = 1.0;
  CalibrationScene scene = SceneFor(ForeignFormat::kKalibr, 30);
  std::vector<CameraCalibration> pair{scene.cameras[1], scene.cameras[1]};
  const RigidTransform turn{Eigen::AngleAxisd(kNearlyRad, Vector3d::UnitX()).toRotationMatrix(),
                            Vector3d(-2.0, 0.0, 0.0)};
  pair[1].cam_from_world = turn * pair[0].cam_from_world;
  const recon::CalibrationInput input = SeenBy(scene, pair, kCoarsePx);
  scene.cameras = pair;
  const std::string refusal = RefusalOf([&] {
    (void)FindConvention(InOrder(Kalibr(scene, {{}, 1000.0})), input, {});
  });
  EXPECT_THAT(refusal, HasSubstr("the board doesn't tell what the poses are"));
}

TEST(ReadLensFile, PicksTheCameraByItsName) {
  const test_support::TemporaryFolder folder;
  const std::string camera =
      "camera_model: pinhole, distortion_model: radtan, distortion_coeffs: [0.1, 0, 0, 0], "
      "resolution: [640, 480], rostopic: /{}/image_raw, intrinsics: [{}, 500, 320, 240] }}\n";
  test_support::WriteText(
      folder / "camchain.yaml",
      fmt::format(fmt::runtime("cam0: {{ " + camera + "cam1: {{ " + camera), "left", 500, "right", 600));
  EXPECT_EQ(ReadLensFile(folder / "camchain.yaml", "cam_1").camera_matrix(0, 0), 600.0);
  EXPECT_EQ(ReadLensFile(folder / "camchain.yaml", "right").camera_matrix(0, 0), 600.0);
  EXPECT_THAT(RefusalOf([&] { (void)ReadLensFile(folder / "camchain.yaml", "cam7"); }),
              HasSubstr("has no camera 'cam7', only 'cam0', 'cam1'"));
  test_support::WriteText(
      folder / "one.toml",
      "[cam_0]\nname = \"A\"\nsize = [640, 480]\nmatrix = [[500, 0, 320], [0, 500, 240], [0, 0, 1]]\n"
      "distortions = [0.1, 0, 0, 0, 0]\n");
  const CameraCalibration only = ReadLensFile(folder / "one.toml", "cam7");
  EXPECT_EQ(only.name, "cam7");
  EXPECT_EQ(only.image_width_px, 640);
}

TEST(ReadLensFile, WhatIsWrongIsOneLineThatNamesThePlace) {
  const test_support::TemporaryFolder folder;
  const auto refusal = [&](const std::string& text, const char* name = "a.toml") {
    test_support::WriteText(folder / name, text);
    const std::string line = RefusalOf([&] { (void)ReadLensFile(folder / name, "cam"); });
    EXPECT_THAT(line, HasSubstr(name));
    return line;
  };
  const std::string head = "[cam_0]\nname = \"A\"\nsize = [640, 480]\n";
  EXPECT_THAT(refusal("[metadata]\nerror = 1\n"), HasSubstr("holds no camera"));
  EXPECT_THAT(refusal(head + "matrix = [1, 2]\ndistortions = []\n"), HasSubstr(":4: [cam_0]: key 'matrix'"));
  EXPECT_THAT(refusal(head + "matrix = [[500, 0, 320], [0, 500, 240], [0, 0, 1]]\n"),
              HasSubstr("'distortions' is missing"));
  EXPECT_THAT(refusal("[cam_0]\nmatrix = [1]\nsize = [-4, 5]\n"), HasSubstr("[width, height]"));
  EXPECT_THAT(refusal("[cam_0\n"), HasSubstr("not TOML"));
  EXPECT_THAT(refusal("1 2 3\n", "a.txt"), HasSubstr("12 a camera"));
  EXPECT_THAT(refusal("<html></html>", "a.xml"), HasSubstr("must be <opencv_storage>"));
  EXPECT_THAT(refusal("{ \"a\": 1 }", "a.json"), HasSubstr("holds no camera"));
}

}  // namespace
}  // namespace elbowroom::control
