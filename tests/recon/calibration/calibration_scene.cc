#include "tests/recon/calibration/calibration_scene.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "recon/boards/resting_board.h"
#include "recon/calibration/board_surface.h"
#include "recon/calibration/rotation.h"
#include "tests/recon/calibration/scene_views.h"

namespace elbowroom::recon {
namespace {

using core::CameraCalibration;
using core::DistortionModel;
using core::RigidTransform;
using Eigen::Vector2d;
using Eigen::Vector3d;

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

// Adds views to a scene that has cameras.
class SceneBuilder {
 public:
  SceneBuilder(const CalibrationSceneOptions& options, TrueBoard board, Random* random,
               CalibrationScene* scene)
      : options_(options),
        board_(std::move(board)),
        motion_(board_.surface.center(), random),
        models_(scene->cameras.begin(), scene->cameras.end()),
        random_(*random),
        scene_(*scene) {}

  void RecordMotion();
  void TakeLensPhotos();
  // A board at rest is many pictures, each with its noise.
  void AddNoiseAndMergeRest();

 private:
  void AddSet(double t_s, int set);
  // Another pose, points that are wrong, half of them hidden.
  void AddView(std::size_t camera, const RigidTransform& world_from_board, Fault fault, CalibrationView view);

  const CalibrationSceneOptions& options_;
  TrueBoard board_;
  BoardMotion motion_;
  std::vector<core::CameraModel> models_;
  Random& random_;
  CalibrationScene& scene_;
};

void SceneBuilder::RecordMotion() {
  constexpr double kMotionS = 60.0, kStartS = 1.0;  // after a rest; the board moves from 0.5 s on
  const double period_s = scene_.input.frame_period_s;
  const int between =
      std::max(options_.frames_of_run + 5, static_cast<int>(kMotionS / period_s / options_.runs));
  const int rests = options_.rest_s > 0.0 ? 1 : 0;
  if (rests > 0) AddSet(-0.5 * options_.rest_s, 0);
  for (int i = 0; i < options_.runs * options_.frames_of_run; ++i) {
    const double t_s = (i / options_.frames_of_run * between + i % options_.frames_of_run) * period_s;
    AddSet(t_s + rests * kStartS, i + rests);
  }
}

void SceneBuilder::AddSet(double t_s, int set) {
  scene_.world_from_board.push_back(motion_.WorldFromBoardAt(t_s));
  for (std::size_t camera = 0; camera < models_.size(); ++camera) {
    const RigidTransform world_from_board = motion_.WorldFromBoardAt(t_s + scene_.offsets_s[camera]);
    if (Look(models_[camera], world_from_board, board_.points, options_.sigma_px).points.empty()) continue;
    // The world's set is as it should be; its faults have tests of their own.
    const Fault fault = DrawFault(set > 0 ? options_.wrong_share : 0.0, &random_);
    AddView(camera, world_from_board, fault,
            {static_cast<int>(camera), set, t_s, {}, "frame " + std::to_string(set)});
  }
}

void SceneBuilder::AddView(std::size_t camera, const RigidTransform& world_from_board, Fault fault,
                           CalibrationView view) {
  view.sighting = Look(models_[camera], world_from_board, board_.points, options_.sigma_px);
  if (fault == Fault::kMirrored) {
    const BoardSighting seen =
        Look(models_[camera], MirroredFor(models_[camera], world_from_board, board_.surface.center()),
             board_.points, options_.sigma_px);
    if (!seen.points.empty()) view.sighting = seen;
  }
  if (random_.Chance(options_.occluded_share)) HideHalf(board_.points, &random_, &view.sighting);
  Disturb(fault, &random_, &view.sighting);
  if (!board_.surface.half_turn().empty() && random_.Chance(0.5))
    NumberFromOtherEnd(board_.surface, &view.sighting);
  scene_.input.views.push_back(std::move(view));
  scene_.is_wrong.push_back(fault != Fault::kNone);
  scene_.is_mirrored.push_back(fault == Fault::kMirrored);
}

void SceneBuilder::TakeLensPhotos() {
  for (std::size_t camera = 0; camera < models_.size(); ++camera)
    for (int i = 0; i < options_.lens_photos; ++i) {
      const RigidTransform world_from_board = DrawLensPhoto(models_[camera], board_, &random_);
      AddView(camera, world_from_board, DrawFault(options_.wrong_share, &random_),
              {static_cast<int>(camera), std::nullopt, 0.0, {}, "photo " + std::to_string(i)});
    }
}

void SceneBuilder::AddNoiseAndMergeRest() {
  const int pictures = static_cast<int>(options_.rest_s / scene_.input.frame_period_s);
  for (CalibrationView& view : scene_.input.views) {
    const BoardSighting clean = view.sighting;
    AddNoiseTo(options_.noise_px, &random_, &view.sighting);
    if (view.set != 0 || pictures < 2) continue;
    RestingBoard rest(options_.board, view.sighting);
    for (int i = 1; i < pictures; ++i) {
      BoardSighting next = clean;
      AddNoiseTo(options_.noise_px, &random_, &next);
      (void)rest.Add(next);
    }
    view.sighting = rest.Mean();
  }
}

}  // namespace

void AddNoise(double noise_px, Random* random, CalibrationInput* input) {
  for (CalibrationView& view : input->views) AddNoiseTo(noise_px, random, &view.sighting);
}

CalibrationScene MakeCalibrationScene(const CalibrationSceneOptions& options, std::uint64_t seed) {
  Random random(seed);
  CalibrationScene scene = SceneWithoutViews(options, &random);
  const Vector3d bend(random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0));
  SceneBuilder builder(options, TrueBoard(options.board, options.bend_mm * bend), &random, &scene);
  builder.RecordMotion();
  builder.TakeLensPhotos();
  if (!BoardSurface(options.board).half_turn().empty())
    NumberWorldAsSeen(BoardSurface(options.board), &scene);
  MoveWorldToFirstBoard(&scene);
  builder.AddNoiseAndMergeRest();
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

CalibrationSceneOptions RecommendedSceneOptions(std::uint64_t seed) {
  CalibrationSceneOptions options = RandomSceneOptions(seed);
  Random random(seed * 6007 + 5);
  options.frames_of_run = 3;
  options.runs = random.Whole(17, 33);
  options.rest_s = random.Uniform(1.0, 2.0);
  options.lens_photos = random.Whole(30, 40);
  // The same plate with smaller squares: 165 corners instead of 70 and 63.
  options.board = options.board.kind == BoardKind::kChessboard
                      ? Board{BoardKind::kChessboard, 16, 12, 40.0, 0.0, ""}
                      : Board{BoardKind::kCharuco, 16, 12, 40.0, 28.0, "DICT_5X5_100"};
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
