// The same detections given to mrcal: the same optimum, and the same uncertainty where both say the same
// thing. See docs/calibration.md, "Beside mrcal".
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "recon/boards/board_finder.h"
#include "recon/calibration/calibrate.h"
#include "recon/calibration/lens_projection.h"
#include "recon/calibration/rotation.h"
#include "tests/recon/calibration/calibration_scene.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector3d;
using nlohmann::json;

const std::filesystem::path kPython = "/usr/bin/python3";  // Debian's, which its package mrcal is for
const std::filesystem::path kOracle = test_support::SourceFolder() / "tests/oracles/mrcal_oracle.py";

bool HasMrcal() {
  return std::filesystem::exists(kPython) &&
         test_support::RunProgram(kPython, {"-c", "import mrcal"}).exit_status == 0;
}

#define SKIP_WITHOUT_MRCAL()                                                                          \
  if (!HasMrcal())                                                                                    \
  GTEST_SKIP()                                                                                        \
      << "NOT TESTED: mrcal isn't installed (Debian's packages mrcal and python3-mrcal), so nothing " \
         "was held against it"

// How many columns and rows of points a board has.
std::pair<int, int> GridOf(const Board& board) {
  const int less = board.kind == BoardKind::kCharuco ? 1 : 0;
  return {board.columns - less, board.rows - less};
}

double MeanSigma(const CalibrationInput& input, const CalibrationResult& result) {
  double sum_px = 0.0;
  int count = 0;
  for (std::size_t v = 0; v < input.views.size(); ++v) {
    for (const PointResidual& residual : result.views[v].residuals) {
      if (!residual.is_used) continue;
      const auto& points = input.views[v].sighting.points;
      sum_px += std::ranges::find(points, residual.point, &SightedPoint::point)->sigma_px;
      ++count;
    }
  }
  return sum_px / count;
}

// mrcal's table of corners, of the points that our fit used: a whole grid for each picture, points without a
// weight left out.
std::string CornersOf(const CalibrationInput& input, const CalibrationResult& result) {
  const auto [columns, rows] = GridOf(input.board);
  const double mean_sigma_px = MeanSigma(input, result);
  std::string text = "# filename x y weight\n";
  int lone_frame = 100'000;
  for (std::size_t v = 0; v < input.views.size(); ++v) {
    const CalibrationView& view = input.views[v];
    std::map<int, std::string> used;
    for (const PointResidual& residual : result.views[v].residuals) {
      if (!residual.is_used) continue;
      const auto& points = view.sighting.points;
      const double sigma_px = std::ranges::find(points, residual.point, &SightedPoint::point)->sigma_px;
      used[residual.point] = fmt::format("{:.17g} {:.17g} {:.17g}", residual.pixel.x(), residual.pixel.y(),
                                         mean_sigma_px / sigma_px);
    }
    if (used.empty()) continue;
    const int frame = view.set ? *view.set : lone_frame++;
    for (int i = 0; i < columns * rows; ++i)
      text +=
          fmt::format("frame{:06}-cam{}.png {}\n", frame, view.camera, used.contains(i) ? used[i] : "- - -");
  }
  return text;
}

json JsonOf(const RigidTransform& pose) {
  json rows = json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({pose.rotation(i, 0), pose.rotation(i, 1), pose.rotation(i, 2)});
  return {{"rotation", rows},
          {"translation_mm", {pose.translation_mm.x(), pose.translation_mm.y(), pose.translation_mm.z()}}};
}

// The truth, disturbed: focal lengths by 2 %, no distortion, poses by up to 1 degree and 10 mm.
json StartNear(const CalibrationScene& scene) {
  constexpr double kFocalShare = 1.02, kTurnRad = 0.017, kShiftMm = 10.0;
  Random random(5);
  const auto disturbed = [&](const RigidTransform& pose) {
    const Eigen::Matrix3d turn = RotationFromVector(random.Uniform(0.0, kTurnRad) * random.Direction());
    return JsonOf({turn * pose.rotation, pose.translation_mm + kShiftMm * random.Direction()});
  };
  json start = {
      {"intrinsics", json::array()}, {"cam_from_cam0", json::array()}, {"cam0_from_board", json::object()}};
  const RigidTransform& cam0_from_world = scene.cameras[0].cam_from_world;
  for (const core::CameraCalibration& camera : scene.cameras) {
    start["intrinsics"].push_back({kFocalShare * camera.camera_matrix(0, 0),
                                   kFocalShare * camera.camera_matrix(1, 1), 0.5 * camera.image_width_px,
                                   0.5 * camera.image_height_px});
    start["cam_from_cam0"].push_back(disturbed(camera.cam_from_world * cam0_from_world.Inverse()));
  }
  const RigidTransform board_from_first{Eigen::Matrix3d::Identity(), PointsOf(scene.input.board).front()};
  for (std::size_t k = 0; k < scene.world_from_board.size(); ++k)
    start["cam0_from_board"][std::to_string(k)] =
        disturbed(cam0_from_world * scene.world_from_board[k] * board_from_first);
  return start;
}

// mrcal takes residuals as independent, so the covariance is that of independent ones here.
CalibrationResult CalibrateAsMrcal(const CalibrationInput& input) {
  CalibrationResult result = Calibrate(input);
  result.covariance /= result.uncertainty_scale * result.uncertainty_scale;
  return result;
}

// What mrcal finds, with our noise for its covariances. `points`: in the world, which is the first frame's
// board.
json RunMrcal(const CalibrationInput& input, const CalibrationResult& result, const std::string& lensmodel,
              const std::vector<Vector3d>& points, const json& start = {}) {
  const test_support::TemporaryFolder folder;
  const auto [columns, rows] = GridOf(input.board);
  json scene = {{"columns", columns},
                {"rows", rows},
                {"square_mm", input.board.square_mm},
                {"lensmodel", lensmodel},
                {"noise_px", result.noise_px},
                {"cameras", json::array()},
                {"points_mm", json::array()}};
  if (!start.is_null()) scene["start"] = start;
  // The board's first point need not be its origin.
  const Vector3d first = PointsOf(input.board).front();
  for (const CalibrationCamera& camera : input.cameras)
    scene["cameras"].push_back(
        {{"width", camera.width_px}, {"height", camera.height_px}, {"focal_px", 0.9 * camera.width_px}});
  for (const Vector3d& x : points)
    scene["points_mm"].push_back({x.x() - first.x(), x.y() - first.y(), x.z() - first.z()});
  test_support::WriteText(folder / "scene.json", scene.dump());
  test_support::WriteText(folder / "corners.vnl", CornersOf(input, result));
  const auto run = test_support::RunProgram(
      kPython, {kOracle.string(), (folder / "scene.json").string(), (folder / "corners.vnl").string()});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  return run.exit_status == 0 ? json::parse(run.out) : json();
}

RigidTransform PoseOf(const json& camera) {
  RigidTransform pose;
  for (int i = 0; i < 3; ++i) {
    pose.translation_mm[i] = camera["translation_cam_from_cam0_mm"][static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k)
      pose.rotation(i, k) =
          camera["rotation_cam_from_cam0"][static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  }
  return pose;
}

// Of the pixel of a point that stands still in the world, in its worst direction: from the joint covariance
// of the camera's lens and pose.
double WorstPixelSigma(const CalibrationResult& result, std::size_t i, const Vector3d& x_in_world) {
  const CalibratedCamera& camera = result.cameras[i];
  const ParameterBlock& block = camera.parameters;
  const RigidTransform& cam_from_world = camera.calibration.cam_from_world;
  const auto projected =
      ProjectWithDerivatives(LensParametersOf(camera.calibration), cam_from_world * x_in_world).value();
  Eigen::MatrixXd by_parameters(2, block.intrinsics + 6);
  by_parameters << projected.by_values, -projected.by_x_in_cam * Hat(cam_from_world.rotation * x_in_world),
      projected.by_x_in_cam;
  const Eigen::Matrix2d covariance =
      by_parameters *
      result.covariance.block(block.first, block.first, block.intrinsics + 6, block.intrinsics + 6) *
      by_parameters.transpose();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[1]);
}

struct Agreement {
  double rms_px = 0.0;             // difference
  double intrinsics_sigmas = 0.0;  // largest difference, in its standard deviations
  double sigma_ratio = 0.0;        // of intrinsics: |ours / theirs - 1|, the largest
  double pose_sigmas = 0.0;        // of a camera's translation relative to the first
  double turn_rad = 0.0;
  double pixel_ratio = 0.0;  // of a fixed point's pixel sigma: |ours / theirs - 1|, the largest
};

void Print(const CalibrationResult& result, const json& theirs, const std::vector<Vector3d>& points) {
  std::printf("RMS %.4f px, mrcal %.4f; noise %.4f px, mrcal %.4f (%.4f as it states it)\n", result.rms_px,
              theirs["rms_px"].get<double>(), result.noise_px, theirs["noise_px"].get<double>(),
              theirs["mrcal_noise_px"].get<double>());
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    const json& camera = theirs["cameras"][i];
    const CalibratedCamera& ours = result.cameras[i];
    const int at = ours.parameters.first;
    const RigidTransform relative =
        ours.calibration.cam_from_world * result.cameras[0].calibration.cam_from_world.Inverse();
    std::printf("  %s: fx %.3f +- %.3f, mrcal %.3f +- %.3f; from the first %.3f mm, mrcal %.3f\n",
                ours.calibration.name.c_str(), ours.calibration.camera_matrix(0, 0),
                std::sqrt(result.covariance(at, at)), camera["intrinsics"][0].get<double>(),
                camera["intrinsics_sigma"][0].get<double>(), relative.translation_mm.norm(),
                PoseOf(camera).translation_mm.norm());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const json& point = camera["points"][k];
      std::printf(
          "    point (%.0f, %.0f, %.0f): %.4f px; mrcal: fixed to the first board %.4f, to the mean of all "
          "%.4f, at infinity %.4f\n",
          points[k].x(), points[k].y(), points[k].z(), WorstPixelSigma(result, i, points[k]),
          point["first_board_px"].get<double>(), point["all_boards_px"].get<double>(),
          point["at_infinity_px"].get<double>());
    }
  }
}

Agreement Compare(const CalibrationResult& result, const json& theirs, const char* key,
                  const std::vector<Vector3d>& points) {
  Agreement agreement;
  agreement.rms_px = std::abs(result.rms_px - theirs["rms_px"].get<double>());
  const auto grow = [](double value, double* largest) { *largest = std::max(*largest, value); };
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    const json& camera = theirs[key][i];
    const CalibratedCamera& ours = result.cameras[i];
    const Eigen::VectorXd values = LensParametersOf(ours.calibration).values;
    for (int k = 0; k < values.size(); ++k) {
      const int at = ours.parameters.first + k;
      const double sigma = std::sqrt(result.covariance(at, at)),
                   their_sigma = camera["intrinsics_sigma"][static_cast<std::size_t>(k)];
      grow(
          std::abs(values[k] - camera["intrinsics"][static_cast<std::size_t>(k)].get<double>()) / their_sigma,
          &agreement.intrinsics_sigmas);
      grow(std::abs(sigma / their_sigma - 1.0), &agreement.sigma_ratio);
    }
    for (std::size_t k = 0; k < points.size(); ++k)
      grow(std::abs(WorstPixelSigma(result, i, points[k]) /
                        camera["points"][k]["first_board_px"].get<double>() -
                    1.0),
           &agreement.pixel_ratio);
    if (i == 0) continue;
    const RigidTransform relative =
        ours.calibration.cam_from_world * result.cameras[0].calibration.cam_from_world.Inverse();
    const RigidTransform their_relative = PoseOf(camera);
    for (int k = 0; k < 3; ++k)
      grow(std::abs(relative.translation_mm[k] - their_relative.translation_mm[k]) /
               camera["translation_sigma_mm"][static_cast<std::size_t>(k)].get<double>(),
           &agreement.pose_sigmas);
    grow(VectorFromRotation(relative.rotation.transpose() * their_relative.rotation).norm(),
         &agreement.turn_rad);
  }
  std::printf(
      "  %s: apart by %.1e px RMS, %.1e sigma in lenses, %.1e sigma in places, %.1e rad; sigmas by %.1e of "
      "themselves, of pixels %.1e\n",
      key, agreement.rms_px, agreement.intrinsics_sigmas, agreement.pose_sigmas, agreement.turn_rad,
      agreement.sigma_ratio, agreement.pixel_ratio);
  return agreement;
}

// Both find the minimum of the same sum of squares, so what is left are the fits' ends and our weak knowledge
// of the lens (0 +- 1 for each coefficient), which moves a coefficient k of sigma s by s^2 k.
constexpr double kMostSigmas = 0.05;
constexpr double kMostRmsPx = 1e-4;
// The same derivatives at the same place.
constexpr double kSameSigma = 0.02;

void ExpectAgreement(const Agreement& agreement) {
  EXPECT_LE(agreement.rms_px, kMostRmsPx);
  EXPECT_LE(agreement.intrinsics_sigmas, kMostSigmas);
  EXPECT_LE(agreement.pose_sigmas, kMostSigmas);
  EXPECT_LE(agreement.sigma_ratio, kSameSigma);
  EXPECT_LE(agreement.pixel_ratio, kSameSigma);
}

const std::vector<Vector3d>& PointsToAsk() {
  static const std::vector<Vector3d> points = {
      {300.0, -210.0, 0.0}, {300.0, -210.0, 200.0}, {0.0, 0.0, 100.0}, {700.0, 150.0, 50.0}};
  return points;
}

CalibrationScene SyntheticScene(std::uint64_t seed, int cameras) {
  CalibrationSceneOptions options = StillBoardOptions();
  options.cameras = cameras;
  options.runs = 25;
  options.has_plain_lenses = true;
  CalibrationScene scene = MakeCalibrationScene(options, seed);
  scene.input.has_flat_board = true;
  return scene;
}

TEST(Mrcal, FindsTheSameRigAndTheSameUncertainty) {
  SKIP_WITHOUT_MRCAL();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const CalibrationScene scene = SyntheticScene(seed, 2 + static_cast<int>(seed));
    const CalibrationResult result = CalibrateAsMrcal(scene.input);
    const json theirs = RunMrcal(scene.input, result, "LENSMODEL_OPENCV5", PointsToAsk(), StartNear(scene));
    ASSERT_FALSE(theirs.is_null());
    EXPECT_EQ(theirs["points"], result.points);
    Print(result, theirs, PointsToAsk());
    (void)Compare(result, theirs, "cameras", PointsToAsk());
    ExpectAgreement(Compare(result, theirs, "knowing_lenses", PointsToAsk()));
  }
}

// Eight coefficients where five would do: the pictures don't tell most of them, and only what was known
// before keeps them in bounds. What they do to a point is told all the same.
TEST(Mrcal, ARationalLensThatThePicturesDoNotTellMovesNoPose) {
  SKIP_WITHOUT_MRCAL();
  // Between a fit that knows 0 +- 1 of each coefficient and one that doesn't, poses move by a share of a
  // sigma.
  constexpr double kShareOfSigma = 0.2;
  // Twelve more unknowns fit away chi squared of 12 of 12,000: 5e-4 of the sum, 1e-4 px; our bounds on them
  // keep some of it.
  constexpr double kFittedAwayPx = 5e-4;
  CalibrationScene scene = SyntheticScene(2, 4);
  for (CalibrationCamera& camera : scene.input.cameras)
    camera.distortion_model = core::DistortionModel::kRationalPolynomial;
  const CalibrationResult result = CalibrateAsMrcal(scene.input);
  const json theirs = RunMrcal(scene.input, result, "LENSMODEL_OPENCV8", PointsToAsk(), StartNear(scene));
  ASSERT_FALSE(theirs.is_null());
  Print(result, theirs, PointsToAsk());
  const Agreement agreement = Compare(result, theirs, "cameras", PointsToAsk());
  EXPECT_LE(agreement.rms_px, kFittedAwayPx);
  EXPECT_LE(agreement.pose_sigmas, kShareOfSigma);
}

// Sightings of OpenCV's stereo pair; empty: the pictures aren't here.
CalibrationInput StereoPair() {
  const std::filesystem::path folder = test_support::SharedDataFolder() / "calibration/chessboard";
  CalibrationInput input;
  input.board = {BoardKind::kChessboard, 9, 6, 25.0, 0.0, ""};
  input.has_flat_board = true;
  input.cameras = {{"left", 640, 480, core::DistortionModel::kPlumbBob, std::nullopt},
                   {"right", 640, 480, core::DistortionModel::kPlumbBob, std::nullopt}};
  const BoardFinder finder(input.board);
  int set = 0;
  for (int picture = 1; picture <= 14; ++picture) {
    bool is_there = false;
    for (int camera = 0; camera < 2; ++camera) {
      const auto path =
          folder / fmt::format("{}{:02}.jpg", input.cameras[static_cast<std::size_t>(camera)].name, picture);
      const cv::Mat image = std::filesystem::exists(path) ? cv::imread(path.string()) : cv::Mat();
      const auto sighting = image.empty() ? std::nullopt : finder.Find(image);
      if (sighting) input.views.push_back({camera, set, 0.0, *sighting, path.filename().string()});
      is_there = is_there || sighting.has_value();
    }
    set += is_there ? 1 : 0;
  }
  return input;
}

TEST(Mrcal, FindsTheSameRigFromRealPictures) {
  SKIP_WITHOUT_MRCAL();
  const CalibrationInput input = StereoPair();
  if (input.views.empty())
    GTEST_SKIP() << "NOT TESTED: OpenCV's stereo pair isn't in " << test_support::SharedDataFolder().string();
  const CalibrationResult result = CalibrateAsMrcal(input);
  const std::vector<Vector3d> points = {{100.0, -60.0, 0.0}, {100.0, -60.0, 100.0}, {0.0, 0.0, -100.0}};
  const json theirs = RunMrcal(input, result, "LENSMODEL_OPENCV5", points);
  ASSERT_FALSE(theirs.is_null());
  EXPECT_EQ(theirs["points"], result.points);
  Print(result, theirs, points);
  (void)Compare(result, theirs, "cameras", points);
  ExpectAgreement(Compare(result, theirs, "knowing_lenses", points));
}

}  // namespace
}  // namespace elbowroom::recon
