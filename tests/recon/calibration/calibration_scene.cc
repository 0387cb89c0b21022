#include "tests/recon/calibration/calibration_scene.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "recon/calibration/board_surface.h"
#include "recon/calibration/planar_pose.h"
#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

using core::CameraCalibration;
using core::DistortionModel;
using core::RigidTransform;
using Eigen::Vector2d;
using Eigen::Vector3d;

double Normal(Random* random) {
  // Box and Muller; the engine's own normal distribution differs between libraries.
  const double radius = std::sqrt(-2.0 * std::log(random->Uniform(1e-300, 1.0)));
  return radius * std::cos(random->Uniform(0.0, 2.0 * std::numbers::pi));
}

std::vector<double> DrawDistortion(DistortionModel model, bool is_plain, Random* random) {
  const auto draw = [random](double low, double high) { return random->Uniform(low, high); };
  if (is_plain) return {draw(-0.1, 0.05), draw(-0.02, 0.02), draw(-5e-4, 5e-4), draw(-5e-4, 5e-4), 0.0};
  switch (model) {
    case DistortionModel::kPlumbBob:
      return {draw(-0.35, 0.1), draw(-0.05, 0.15), draw(-1e-3, 1e-3), draw(-1e-3, 1e-3), draw(-0.03, 0.01)};
    case DistortionModel::kRationalPolynomial: {
      const double k4 = draw(0.0, 0.6), k5 = draw(0.0, 0.2);
      return {k4 + draw(-0.4, 0.05),
              k5 + draw(-0.1, 0.1),
              draw(-1e-3, 1e-3),
              draw(-1e-3, 1e-3),
              draw(-0.01, 0.02),
              k4,
              k5,
              draw(0.0, 0.02)};
    }
    case DistortionModel::kFisheye:
      return {draw(-0.05, 0.05), draw(-0.02, 0.02), draw(-0.01, 0.01), draw(-0.003, 0.003)};
  }
  return {};
}

// Whether the lens is one-to-one over the whole picture.
bool CoversPicture(const CameraCalibration& camera) {
  try {
    const core::CameraModel model(camera);
    for (const double x : {0.0, camera.image_width_px - 1.0})
      for (const double y : {0.0, camera.image_height_px - 1.0})
        if (!model.NormalisedFromPixel({x, y})) return false;
  } catch (const core::Error&) {
    return false;
  }
  return true;
}

CameraCalibration DrawLens(const CalibrationSceneOptions& options, Random* random) {
  constexpr std::array<std::pair<int, int>, 3> kSizes = {{{640, 480}, {800, 600}, {1280, 720}}};
  constexpr std::array<DistortionModel, 3> kModels = {
      DistortionModel::kPlumbBob, DistortionModel::kRationalPolynomial, DistortionModel::kFisheye};
  CameraCalibration camera;
  const auto [width, height] = kSizes[static_cast<std::size_t>(random->Whole(0, 2))];
  camera.image_width_px = width;
  camera.image_height_px = height;
  camera.distortion_model = options.has_plain_lenses ? DistortionModel::kPlumbBob
                                                     : kModels[static_cast<std::size_t>(random->Whole(0, 2))];
  const bool is_fisheye = camera.distortion_model == DistortionModel::kFisheye;
  do {
    const double focal_px = width * (is_fisheye ? random->Uniform(0.5, 0.8) : random->Uniform(0.75, 1.3));
    camera.camera_matrix << focal_px, 0.0, 0.5 * width + random->Uniform(-15.0, 15.0), 0.0,
        focal_px * random->Uniform(0.998, 1.002), 0.5 * height + random->Uniform(-15.0, 15.0), 0.0, 0.0, 1.0;
    camera.distortion_coefficients =
        DrawDistortion(camera.distortion_model, options.has_plain_lenses, random);
  } while (!CoversPicture(camera));
  return camera;
}

// On an arc of 150 degrees around the table.
std::vector<CameraCalibration> DrawCameras(const CalibrationSceneOptions& options, Random* random) {
  constexpr double kArcRad = 150.0 * std::numbers::pi / 180.0;
  std::vector<CameraCalibration> cameras;
  for (int i = 0; i < options.cameras; ++i) {
    CameraCalibration camera = DrawLens(options, random);
    camera.name = "cam" + std::to_string(i + 1);
    const double share = options.cameras > 1 ? static_cast<double>(i) / (options.cameras - 1) - 0.5 : 0.0;
    const double azimuth = kArcRad * share + random->Uniform(-0.1, 0.1);
    const double elevation = random->Uniform(0.5, 1.1), distance_mm = random->Uniform(1000.0, 2200.0);
    const Vector3d eye(distance_mm * std::cos(elevation) * std::cos(azimuth),
                       distance_mm * std::cos(elevation) * std::sin(azimuth),
                       distance_mm * std::sin(elevation));
    const Vector3d target(random->Uniform(-60.0, 60.0), random->Uniform(-60.0, 60.0),
                          random->Uniform(0.0, 120.0));
    camera.cam_from_world = core::CamFromWorldLookingAt(eye, target);
    camera.cam_from_world.rotation =
        RotationFromVector({0.0, 0.0, random->Uniform(-0.2, 0.2)}) * camera.cam_from_world.rotation;
    cameras.push_back(camera);
  }
  return cameras;
}

// A hand's motion: three sines for each coordinate of position and tilt. It begins at rest on the table.
class BoardMotion {
 public:
  BoardMotion(const Vector3d& center_in_board, Random* random) : center_in_board_(center_in_board) {
    for (auto& coordinate : waves_)
      for (Wave& wave : coordinate)
        wave = {random->Uniform(0.05, 0.35), random->Uniform(0.0, 2.0 * std::numbers::pi),
                random->Uniform(0.4, 1.0)};
  }

  [[nodiscard]] RigidTransform WorldFromBoardAt(double t_s) const {
    // The middle of the workspace at most 350 mm away, tilts of up to 0.7 rad, turns about z too. The cameras
    // stand on the +x side, so the board leans that way.
    const Vector3d position(220.0 * At(0, t_s), 260.0 * At(1, t_s), 150.0 + 150.0 * At(2, t_s));
    const Vector3d turn(0.6 * At(3, t_s), 0.35 + 0.55 * At(4, t_s), 0.8 * At(5, t_s));
    const double begun = std::clamp((t_s - 0.5) / 1.5, 0.0, 1.0);
    const double share =
        begun * begun * begun * (10.0 - begun * (15.0 - 6.0 * begun));  // smooth to the second order
    RigidTransform world_from_board{RotationFromVector(share * turn), Vector3d::Zero()};
    world_from_board.translation_mm =
        share * position - world_from_board.rotation * center_in_board_ + (1.0 - share) * center_in_board_;
    return world_from_board;
  }

 private:
  struct Wave {
    double hz = 0.0, phase = 0.0, size = 0.0;
  };
  [[nodiscard]] double At(std::size_t coordinate, double t_s) const {
    double sum = 0.0;
    for (const Wave& wave : waves_[coordinate])
      sum += wave.size * std::sin(2.0 * std::numbers::pi * wave.hz * t_s + wave.phase);
    return sum / 1.5;
  }
  Vector3d center_in_board_;
  std::array<std::array<Wave, 3>, 6> waves_;
};

// What a camera sees of the board: the points in its picture. Empty: too few, from behind, or too much
// aslant.
BoardSighting Look(const core::CameraModel& camera, const RigidTransform& world_from_board,
                   const std::vector<Vector3d>& points, double sigma_px) {
  constexpr double kMostSlant = 0.26;  // cosine of 75 degrees
  constexpr std::size_t kLeastPoints = 8;
  const RigidTransform cam_from_board = camera.cam_from_world() * world_from_board;
  const Vector3d middle = cam_from_board * points[points.size() / 2];
  BoardSighting sighting;
  if (-cam_from_board.rotation.col(2).dot(middle.normalized()) < kMostSlant) return sighting;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = camera.Project(world_from_board * points[i]);
    if (!pixel || pixel->minCoeff() < 2.0 || pixel->x() > camera.width_px() - 3.0 ||
        pixel->y() > camera.height_px() - 3.0)
      continue;
    sighting.points.push_back({static_cast<int>(i), *pixel, sigma_px});
  }
  if (sighting.points.size() < kLeastPoints) sighting.points.clear();
  return sighting;
}

void HideHalf(const std::vector<Vector3d>& points, Random* random, BoardSighting* sighting) {
  const Vector3d side = random->Direction();
  Vector3d middle = Vector3d::Zero();
  for (const SightedPoint& point : sighting->points)
    middle += points[static_cast<std::size_t>(point.point)] / static_cast<double>(sighting->points.size());
  BoardSighting half;
  for (const SightedPoint& point : sighting->points)
    if (side.head<2>().dot((points[static_cast<std::size_t>(point.point)] - middle).head<2>()) >= 0.0)
      half.points.push_back(point);
  if (half.points.size() >= 8) *sighting = half;
}

// The board's points take each other's numbers, in one of three ways that detectors can go wrong.
void ConfuseNumbers(Random* random, BoardSighting* sighting) {
  auto& points = sighting->points;
  const auto count = static_cast<int>(points.size());
  const int shift = random->Whole(1, std::max(1, count / 2));
  std::vector<Vector2d> pixels;
  for (const SightedPoint& point : points) pixels.push_back(point.pixel);
  for (int i = 0; i < count; ++i)
    points[static_cast<std::size_t>(i)].pixel = pixels[static_cast<std::size_t>((i + shift) % count)];
}

void ShiftPoints(double share, Random* random, BoardSighting* sighting) {
  const Vector2d shift = random->Uniform(6.0, 40.0) * random->Direction().head<2>().normalized();
  for (SightedPoint& point : sighting->points)
    if (random->Chance(share)) point.pixel += shift;
}

// Numbered from the board's other end.
void NumberFromOtherEnd(const BoardSurface& surface, BoardSighting* sighting) {
  for (SightedPoint& point : sighting->points)
    point.point = surface.half_turn()[static_cast<std::size_t>(point.point)];
  std::ranges::sort(sighting->points, {}, &SightedPoint::point);
}

// In the first camera that sees the world's board the first corner is the one with the smaller x + y; where
// the motion has it otherwise, the true board is numbered from its other end.
void NumberWorldAsSeen(const BoardSurface& surface, CalibrationScene* scene) {
  for (const CalibrationView& view : scene->input.views) {
    if (view.set != 0) continue;
    const RigidTransform cam_from_board =
        scene->cameras[static_cast<std::size_t>(view.camera)].cam_from_world *
        scene->world_from_board.front();
    const auto sum_of = [&](int point) { return (cam_from_board * surface.Flat(point)).hnormalized().sum(); };
    if (sum_of(0) <= sum_of(surface.points() - 1)) return;
    const Eigen::Matrix3d turn = Vector3d(-1.0, -1.0, 1.0).asDiagonal();
    const RigidTransform half_turn{turn, surface.center() - turn * surface.center()};
    for (RigidTransform& board : scene->world_from_board) board = board * half_turn;
    return;
  }
}

enum class Fault { kNone, kMirrored, kConfused, kPointsShifted, kViewShifted };
constexpr std::array<Fault, 4> kFaults = {Fault::kMirrored, Fault::kConfused, Fault::kPointsShifted,
                                          Fault::kViewShifted};

void Disturb(Fault fault, Random* random, BoardSighting* sighting) {
  if (fault == Fault::kConfused) ConfuseNumbers(random, sighting);
  if (fault == Fault::kPointsShifted) ShiftPoints(0.4, random, sighting);
  if (fault == Fault::kViewShifted) ShiftPoints(1.0, random, sighting);
}

// The board as a flip would have it.
RigidTransform MirroredFor(const core::CameraModel& camera, const RigidTransform& world_from_board,
                           const BoardSurface& surface) {
  return camera.cam_from_world().Inverse() *
         Flipped(camera.cam_from_world() * world_from_board, surface.center());
}

CalibrationScene SceneWithoutViews(const CalibrationSceneOptions& options, Random* random) {
  CalibrationScene scene;
  CalibrationInput& input = scene.input;
  input.board = options.board;
  input.finds_offsets = options.most_offset > 0.0;
  input.frame_period_s = 1.0 / random->Uniform(25.0, 30.0);
  scene.cameras = DrawCameras(options, random);
  for (const CameraCalibration& camera : scene.cameras) {
    CalibrationCamera given{camera.name, camera.image_width_px, camera.image_height_px, std::nullopt,
                            std::nullopt};
    if (options.gives_models) given.distortion_model = camera.distortion_model;
    input.cameras.push_back(given);
    const double most_s = options.most_offset * input.frame_period_s;
    scene.offsets_s.push_back(scene.offsets_s.empty() ? 0.0 : random->Uniform(-most_s, most_s));
  }
  return scene;
}

// The true world is the board's frame in set 0.
void MoveWorldToFirstBoard(CalibrationScene* scene) {
  const RigidTransform old_from_new = scene->world_from_board.front();
  for (CameraCalibration& camera : scene->cameras)
    camera.cam_from_world = camera.cam_from_world * old_from_new;
  for (RigidTransform& board : scene->world_from_board) board = old_from_new.Inverse() * board;
}

}  // namespace

void AddNoise(double noise_px, Random* random, CalibrationInput* input) {
  for (CalibrationView& view : input->views)
    for (SightedPoint& point : view.sighting.points)
      point.pixel += noise_px * Vector2d(Normal(random), Normal(random));
}

CalibrationScene MakeCalibrationScene(const CalibrationSceneOptions& options, std::uint64_t seed) {
  Random random(seed);
  CalibrationScene scene = SceneWithoutViews(options, &random);
  const BoardSurface surface(options.board);
  const Vector3d bend(random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0));
  std::vector<Vector3d> points;
  for (int i = 0; i < surface.points(); ++i) points.push_back(surface.Bent(i, options.bend_mm * bend));
  const BoardMotion motion(surface.center(), &random);
  std::vector<core::CameraModel> models(scene.cameras.begin(), scene.cameras.end());

  constexpr double kMotionS = 60.0;
  const double period_s = scene.input.frame_period_s;
  const int between =
      std::max(options.frames_of_run + 5, static_cast<int>(kMotionS / period_s / options.runs));
  for (int set = 0; set < options.runs * options.frames_of_run; ++set) {
    const double t_s = (set / options.frames_of_run * between + set % options.frames_of_run) * period_s;
    scene.world_from_board.push_back(motion.WorldFromBoardAt(t_s));
    for (std::size_t camera = 0; camera < models.size(); ++camera) {
      const RigidTransform world_from_board = motion.WorldFromBoardAt(t_s + scene.offsets_s[camera]);
      BoardSighting sighting = Look(models[camera], world_from_board, points, options.sigma_px);
      if (sighting.points.empty()) continue;
      // The world's set is as it should be; its faults have tests of their own.
      const Fault fault = random.Chance(options.wrong_share) && set > 0
                              ? kFaults[static_cast<std::size_t>(random.Whole(0, 3))]
                              : Fault::kNone;
      if (fault == Fault::kMirrored) {
        const BoardSighting seen = Look(
            models[camera], MirroredFor(models[camera], world_from_board, surface), points, options.sigma_px);
        if (!seen.points.empty()) sighting = seen;
      }
      if (random.Chance(options.occluded_share)) HideHalf(points, &random, &sighting);
      Disturb(fault, &random, &sighting);
      if (!surface.half_turn().empty() && random.Chance(0.5)) NumberFromOtherEnd(surface, &sighting);
      scene.input.views.push_back(
          {static_cast<int>(camera), set, t_s, sighting, "frame " + std::to_string(set)});
      scene.is_wrong.push_back(fault != Fault::kNone);
      scene.is_mirrored.push_back(fault == Fault::kMirrored);
    }
  }
  if (!surface.half_turn().empty()) NumberWorldAsSeen(surface, &scene);
  MoveWorldToFirstBoard(&scene);
  AddNoise(options.noise_px, &random, &scene.input);
  return scene;
}

CalibrationSceneOptions RandomSceneOptions(std::uint64_t seed) {
  Random random(seed * 7919 + 17);
  CalibrationSceneOptions options;
  options.cameras = random.Whole(3, 8);
  options.runs = random.Whole(20, 30);
  options.frames_of_run = random.Whole(3, 4);
  options.gives_models = random.Chance(0.5);
  options.bend_mm = random.Chance(0.3) ? 1.0 : 0.0;
  if (random.Chance(0.3)) options.most_offset = 0.0;
  if (random.Chance(0.3))
    options.board = {BoardKind::kChessboard, 10, 8, 55.0, 0.0, ""};  // the same after half a turn
  return options;
}

CameraError ErrorOfCamera(const CalibrationScene& scene, const CalibrationResult& result, int camera) {
  const auto at = static_cast<std::size_t>(camera);
  const RigidTransform& truth = scene.cameras[at].cam_from_world;
  const RigidTransform& found = result.cameras[at].calibration.cam_from_world;
  CameraError error;
  const Vector3d center = truth.Inverse().translation_mm - found.Inverse().translation_mm;
  const Vector3d turn = VectorFromRotation(truth.rotation * found.rotation.transpose());
  error.center_mm = center.norm();
  error.rotation_rad = turn.norm();
  error.center_chi2 = center.dot(CenterCovariance(result, camera).inverse() * center);
  error.rotation_chi2 = turn.dot(RotationCovariance(result, camera).inverse() * turn);
  const std::optional<double> sigma_s = result.cameras[at].time_offset_sigma_s;
  error.has_offset = sigma_s.has_value();
  error.offset_s = result.cameras[at].time_offset_s - scene.offsets_s[at];
  if (sigma_s) error.offset_chi2 = std::pow(error.offset_s / *sigma_s, 2);
  return error;
}

}  // namespace elbowroom::recon
