#include "tests/recon/hull/stress_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr int kWidthPx = 96;
constexpr int kHeightPx = 72;
constexpr double kFarMm = 1e7;
constexpr double kLeastLensFocalPx = 150.0;
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();

struct Ball {
  Vector3d center_in_world;
  double radius_mm;
};

// +-0, +-the least denormal, or a larger one.
double AlmostNothing(Random* random) {
  constexpr std::array<double, 6> kNothings = {0.0, -0.0, kDenormal, -kDenormal, 1e-310, -3e-308};
  return kNothings[static_cast<std::size_t>(random->Whole(0, 5))];
}

// Wide pictures of few pixels stay without: there a straight edge is tenths of a pixel off the lens's.
void AddLens(Random* random, core::CameraCalibration* c) {
  if (c->camera_matrix(1, 1) < kLeastLensFocalPx) return;
  const auto u = [&](double high) { return random->Uniform(-high, high); };
  if (random->Chance(0.5)) {
    c->distortion_coefficients = {u(0.2), u(0.05), u(1e-3), u(1e-3), u(0.02)};
  } else if (random->Chance(0.3)) {
    c->distortion_model = core::DistortionModel::kFisheye;
    c->distortion_coefficients = {u(0.05), u(0.02), u(0.01), u(0.005)};
  }
}

core::CameraCalibration Optics(Random* random, double focal_px) {
  core::CameraCalibration c;
  c.image_width_px = kWidthPx, c.image_height_px = kHeightPx;
  c.camera_matrix << focal_px, random->Chance(0.3) ? 0.1 * focal_px : 0.0,
      kWidthPx * random->Uniform(0.4, 0.6), 0.0, focal_px * random->Uniform(0.7, 1.0),
      kHeightPx * random->Uniform(0.4, 0.6), 0.0, 0.0, 1.0;
  AddLens(random, &c);
  return c;
}

// The middle of the workspace fills most of the picture, or the camera is right in it.
core::RigidTransform PoseAround(Random* random, const StressScene& scene, double focal_px) {
  const double filling_mm = scene.size_mm * focal_px / 30.0;
  const double distance_mm =
      random->Chance(0.15) ? scene.size_mm * random->Uniform(0.05, 1.0) : filling_mm * random->Uniform(1, 2);
  const Vector3d target = scene.middle_in_world + 0.2 * scene.size_mm * random->Direction();
  return core::CamFromWorldLookingAt(target + distance_mm * random->Direction(), target, random->Direction());
}

// The same orientation somewhere else.
core::RigidTransform Beside(const core::RigidTransform& cam_from_world, const Vector3d& shift_in_cam) {
  return {cam_from_world.rotation, cam_from_world.translation_mm + shift_in_cam};
}

core::RigidTransform PoseOf(Random* random, const StressScene& scene, StressKind kind, double focal_px,
                            const std::vector<core::CameraModel>& before) {
  if (before.empty()) return PoseAround(random, scene, focal_px);
  const core::RigidTransform& first = before.front().calibration().cam_from_world;
  if (kind == StressKind::kParallel)
    return Beside(first, random->Uniform(0.0, 0.5) * scene.size_mm * random->Direction());
  if (kind == StressKind::kCoincident) {
    const bool is_same = random->Chance(0.3);
    const double share = random->LogUniform(1e-12, 1e-3);
    return is_same ? first : Beside(first, share * scene.size_mm * random->Direction());
  }
  if (kind == StressKind::kLookingAway && before.size() == 1) {
    core::RigidTransform away = PoseAround(random, scene, focal_px);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(M_PI, Vector3d::UnitY()).toRotationMatrix();
    return {turn * away.rotation, turn * away.translation_mm};
  }
  return PoseAround(random, scene, focal_px);
}

double FocalOf(Random* random, StressKind kind) {
  if (kind == StressKind::kLongFocal) return 50'000.0;
  if (kind == StressKind::kShortFocal) return 50.0;
  return random->LogUniform(50.0, 50'000.0);
}

void Loosen(Random* random, Eigen::Matrix3d* rotation) {
  for (int i = 0; i < 9; ++i) rotation->data()[i] += random->Uniform(-1.6e-7, 1.6e-7);
}

// Straight along an axis, at a round place, with nothings wherever they change nothing.
void PutZeros(Random* random, const StressScene& scene, core::CameraCalibration* c) {
  constexpr std::array<std::array<int, 3>, 3> kAxes = {{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};
  Eigen::Matrix3d rotation;
  // Those at the world's origin have the workspace around them, or in front.
  const bool is_around = scene.middle_in_world.isZero();
  const auto& axes = kAxes[static_cast<std::size_t>(is_around ? random->Whole(0, 2) : 0)];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rotation(row, column) = column == axes[static_cast<std::size_t>(row)] ? 1.0 : AlmostNothing(random);
  c->cam_from_world.rotation = rotation;
  const double distance_mm = scene.size_mm * c->camera_matrix(0, 0) / 30.0;
  c->cam_from_world.translation_mm = {AlmostNothing(random), AlmostNothing(random),
                                      random->Chance(0.8) ? distance_mm : AlmostNothing(random)};
  c->camera_matrix(0, 1) = AlmostNothing(random);
  if (random->Chance(0.2)) c->camera_matrix(0, 2) = AlmostNothing(random);
  c->distortion_model = core::DistortionModel::kPlumbBob;
  c->distortion_coefficients = {AlmostNothing(random), AlmostNothing(random), AlmostNothing(random),
                                AlmostNothing(random), AlmostNothing(random)};
}

core::CameraModel CameraOf(Random* random, const StressScene& scene, StressKind kind,
                           const std::vector<core::CameraModel>& before) {
  const double focal_px = FocalOf(random, kind);
  core::CameraCalibration c = Optics(random, focal_px);
  if (kind == StressKind::kCoincident && !before.empty()) {
    c = before.front().calibration();
  }
  c.name = "stress " + std::to_string(before.size() + 1);
  c.cam_from_world = PoseOf(random, scene, kind, focal_px, before);
  if (kind == StressKind::kLooseRotation) Loosen(random, &c.cam_from_world.rotation);
  if (kind == StressKind::kZeros) PutZeros(random, scene, &c);
  return core::CameraModel(std::move(c));
}

// Whether a ray from a camera's centre meets a ball, or begins in it.
bool Meets(const Vector3d& direction_in_cam, const Vector3d& center_in_cam, double radius_mm) {
  if (center_in_cam.norm() <= radius_mm) return true;
  return direction_in_cam.cross(center_in_cam).norm() <= radius_mm &&
         direction_in_cam.dot(center_in_cam) > 0.0;
}

core::BitMask MaskOf(const core::CameraModel& camera, const std::vector<Ball>& balls) {
  core::BitMask mask(camera.width_px(), camera.height_px());
  for (int y = 0; y < mask.height_px(); ++y) {
    for (int x = 0; x < mask.width_px(); ++x) {
      const auto ray = camera.NormalisedFromPixel(Eigen::Vector2d(x, y));
      if (!ray) continue;
      const Vector3d d = ray->homogeneous().normalized();
      mask.Set(x, y, std::ranges::any_of(balls, [&](const Ball& ball) {
                 return Meets(d, camera.cam_from_world() * ball.center_in_world, ball.radius_mm);
               }));
    }
  }
  return mask;
}

Eigen::AlignedBox3d WorkspaceOf(Random* random, const StressScene& scene, StressKind kind) {
  Vector3d low, high;
  for (int i = 0; i < 3; ++i) {
    low[i] = scene.middle_in_world[i] - scene.size_mm * random->Uniform(0.7, 1.2);
    high[i] = scene.middle_in_world[i] + scene.size_mm * random->Uniform(0.7, 1.2);
    if (kind == StressKind::kZeros && random->Chance(0.3)) low[i] = AlmostNothing(random);
  }
  return {low, high};
}

}  // namespace

std::string_view ToString(StressKind kind) {
  constexpr std::array<std::string_view, kStressKinds> kNames = {
      "random", "parallel", "coincident", "looking away",   "long focal", "short focal",
      "tiny",   "huge",     "far origin", "loose rotation", "zeros"};
  return kNames[static_cast<std::size_t>(kind)];
}

StressScene MakeStressScene(Random* random, StressKind kind) {
  StressScene scene;
  scene.size_mm = random->LogUniform(10.0, 1e4);
  if (kind == StressKind::kTiny) scene.size_mm = 0.5;
  if (kind == StressKind::kHuge) scene.size_mm = 5e5;
  if (kind == StressKind::kZeros && random->Chance(0.5)) scene.middle_in_world.z() = 3.0 * scene.size_mm;
  if (kind == StressKind::kFarOrigin) scene.middle_in_world = kFarMm * random->Direction();
  core::Rig rig;
  rig.name = "stress";
  rig.workspace_mm = WorkspaceOf(random, scene, kind);
  rig.unseen = random->Chance(0.6) ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
  std::vector<Ball> balls;
  for (int n = random->Whole(1, 3); n > 0; --n)
    balls.push_back({scene.middle_in_world + 0.4 * scene.size_mm * random->Direction(),
                     scene.size_mm * random->Uniform(0.2, 0.6)});
  for (int n = random->Whole(1, 5); n > 0; --n) {
    rig.cameras.push_back(CameraOf(random, scene, kind, rig.cameras));
    core::BitMask mask =
        random->Chance(0.1) ? RandomMask(random, kWidthPx, kHeightPx) : MaskOf(rig.cameras.back(), balls);
    scene.masks.push_back(random->Chance(0.5) ? RandomLevels(random, std::move(mask))
                                              : core::SoftMask{std::move(mask), {}});
  }
  scene.rig = std::make_shared<const core::Rig>(std::move(rig));
  return scene;
}

core::CameraModel MakeStressView(Random* random, const StressScene& scene) {
  constexpr int kViewWidthPx = 40, kViewHeightPx = 28;
  core::CameraCalibration c;
  c.name = "view";
  c.image_width_px = kViewWidthPx, c.image_height_px = kViewHeightPx;
  double focal_px = random->LogUniform(20.0, 50'000.0);
  const int place = random->Whole(0, 5);
  const Eigen::AlignedBox3d& box = scene.rig->workspace_mm;
  if (place <= 1) {  // filling the picture, as far off as that is
    c.cam_from_world = PoseAround(random, scene, 2.5 * focal_px);
  } else if (place == 2) {  // inside
    focal_px = random->Uniform(15.0, 60.0);
    const Vector3d eye = random->PointIn(box);
    c.cam_from_world = core::CamFromWorldLookingAt(eye, eye + scene.size_mm * random->Direction());
  } else if (place == 3) {  // a camera's own place, and a hair beside it
    const core::CameraModel& camera = scene.rig->cameras[static_cast<std::size_t>(
        random->Whole(0, static_cast<int>(scene.rig->cameras.size()) - 1))];
    focal_px = camera.calibration().camera_matrix(0, 0) * 0.5;
    c.cam_from_world = camera.cam_from_world();
    const double share =
        random->Chance(0.4) ? random->LogUniform(1e-300, 1e-20) : random->LogUniform(1e-20, 1e-3);
    if (random->Chance(0.7))
      c.cam_from_world = Beside(c.cam_from_world, share * scene.size_mm * random->Direction());
  } else {  // on a face, or a hair beside it
    focal_px = random->Uniform(15.0, 60.0);
    Vector3d eye = random->PointIn(box);
    const int axis = random->Whole(0, 2);
    eye[axis] = (random->Chance(0.5) ? box.min() : box.max())[axis];
    if (place == 5) eye[axis] += random->Uniform(-1.0, 1.0) * random->LogUniform(1e-300, 1e-3);
    c.cam_from_world = core::CamFromWorldLookingAt(eye, scene.middle_in_world, random->Direction());
    if (random->Chance(0.3)) {  // the face parallel to the picture's axes
      c.cam_from_world = {Eigen::Matrix3d::Identity(), -eye};
    }
  }
  c.camera_matrix << focal_px, 0.0, 19.3, 0.0, focal_px, 13.8, 0.0, 0.0, 1.0;
  if (random->Chance(0.3)) c.distortion_coefficients = {-0.15, 0.03, 1e-3, -1e-3, 0.0};
  return core::CameraModel(c);
}

}  // namespace elbowroom::recon
