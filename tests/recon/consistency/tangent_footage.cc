#include "tests/recon/consistency/tangent_footage.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/recon/consistency/capsule_masks.h"
#include "tests/recon/consistency/true_tangents.h"

namespace elbowroom::recon::testing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Where a plane with this angle touches the solids: a point of the end sphere whose own plane it is.
Vector3d TouchedPoint(const EpipolarPair& pair, const Vector3d& center_in_world,
                      const std::vector<Solid>& solids, std::size_t side) {
  double best = side == 0 ? 1e9 : -1e9;
  Vector3d touched = Vector3d::Zero();
  const auto look = [&](const Vector3d& middle, double radius_mm) {
    const Solid sphere{Sphere{radius_mm}, {Eigen::Matrix3d::Identity(), middle}, Vector3d::Zero()};
    const double angle = TrueAnglesRad(pair, center_in_world, {&sphere, 1})[side];
    if (side == 0 ? angle >= best : angle <= best) return;
    best = angle;
    const Vector3d normal = -std::sin(angle) * pair.zero + std::cos(angle) * pair.quarter;
    touched = middle + (side == 0 ? -radius_mm : radius_mm) * normal;
  };
  for (const Solid& solid : solids) {
    const Vector3d& origin = solid.world_from_solid.translation_mm;
    if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) {
      look(origin, sphere->radius_mm);
    } else {
      const auto& capsule = std::get<Capsule>(solid.shape);
      look(origin, capsule.radius_mm);
      look(origin + capsule.length_mm * solid.world_from_solid.rotation.col(2), capsule.radius_mm);
    }
  }
  return touched;
}

Eigen::Matrix3d Turned(const Vector3d& turn_rad) {
  if (turn_rad.norm() == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()).toRotationMatrix();
}

}  // namespace

TangentFootage::TangentFootage(core::Rig rig, HandMotion motion, TangentErrors errors)
    : dilation_px([](core::CameraIndex, double) { return 0.0; }),
      delay_s([](core::CameraIndex, double) { return 0.0; }),
      rig_(std::move(rig)),
      pairs_(std::make_shared<const EpipolarPairs>(rig_, MakeUndistortedPlanes(rig_))),
      motion_(std::move(motion)),
      errors_(errors) {}

core::RigidTransform TangentFootage::TrueCamFromWorld(core::CameraIndex camera, double time_s) const {
  const auto draw = [&](std::uint64_t number) {
    return NormalFrom(errors_.seed, 1'000'000 + 16 * camera + number);
  };
  PoseChange change = PoseChange::Zero();
  if (errors_.calibration_px > 0.0)
    change = ChangeOfSize(*pairs_, camera, {draw(0), draw(1), draw(2)}, {draw(3), draw(4), draw(5)},
                          errors_.calibration_px);
  core::RigidTransform cam_from_world = rig_.cameras[camera].cam_from_world();
  Vector3d center = rig_.cameras[camera].center_in_world() + change.tail<3>();
  cam_from_world.rotation = Turned(change.head<3>()) * cam_from_world.rotation;
  for (const Knock& knock : knocks)
    if (knock.camera == camera && time_s >= knock.from_s) {
      cam_from_world.rotation = Turned(knock.change.head<3>()) * cam_from_world.rotation;
      center += knock.change.tail<3>();
    }
  cam_from_world.translation_mm = -(cam_from_world.rotation * center);
  return cam_from_world;
}

double TangentFootage::ErrorPx(core::CameraIndex camera, const EpipolarPair& pair, std::size_t side,
                               const Vector2d& position, const Vector2d& outwards, double time_s) const {
  const std::uint64_t stream =
      errors_.seed * 4096 + camera * 256 + (camera == pair.a ? pair.b : pair.a) * 2 + side;
  const double white =
      NormalFrom(stream, static_cast<std::uint64_t>(std::llround(time_s * 1e5)) + (1U << 30U));
  constexpr double kNodeS = 0.25;
  const double node = std::floor(time_s / kNodeS), share = time_s / kNodeS - node;
  const double slow = (1.0 - share) * NormalFrom(stream, static_cast<std::uint64_t>(node)) +
                      share * NormalFrom(stream, static_cast<std::uint64_t>(node + 1.0));
  Vector2d field = Vector2d::Zero();
  for (std::uint64_t wave = 0; wave < 4; ++wave) {
    const auto draw = [&](std::uint64_t number) {
      return NormalFrom(errors_.seed, 2'000'000 + 64 * camera + 8 * wave + number);
    };
    const double phase = (draw(0) * position.x() + draw(1) * position.y()) / 150.0 + 10.0 * draw(2);
    field += 0.5 * std::sin(phase) * Vector2d(draw(3), draw(4));
  }
  return errors_.noise_px * white + errors_.slow_noise_px * slow + errors_.lens_px * field.dot(outwards);
}

CameraTangents TangentFootage::TangentsOf(core::CameraIndex camera, double stamp_s) const {
  const double time_s = stamp_s + delay_s(camera, stamp_s);
  const std::vector<Solid> solids = HandsAt(motion_, time_s);
  const core::RigidTransform true_from_world = TrueCamFromWorld(camera, time_s);
  const Vector3d true_center = true_from_world.Inverse().translation_mm;
  const Eigen::Matrix3d& assumed = rig_.cameras[camera].cam_from_world().rotation;
  // Directions in the calibrated camera, and in world as the calibration has it.
  const Eigen::Matrix3d world_from_assumed = true_from_world.rotation.transpose() * assumed;
  const double focal_px = pairs_->plane(camera).focal_px();
  CameraTangents found;
  found.of_other.assign(rig_.cameras.size(), {TangencySkip::kNothingSeen, TangencySkip::kNothingSeen});
  for (const EpipolarPair& pair : pairs_->pairs()) {
    if (pair.a != camera && pair.b != camera) continue;
    EpipolarPair turned = pair;
    turned.axis = world_from_assumed * pair.axis;
    turned.zero = world_from_assumed * pair.zero;
    turned.quarter = world_from_assumed * pair.quarter;
    const auto angles = TrueAnglesRad(turned, true_center, solids);
    for (std::size_t side = 0; side < kTangentSides; ++side) {
      Tangent tangent;
      const Vector3d touched = TouchedPoint(turned, true_center, solids, side);
      const Vector3d in_cam = true_from_world * touched;
      tangent.position = focal_px * in_cam.hnormalized();
      const Eigen::Matrix<double, 2, 3>& rows = pair.From(camera);
      const Vector2d cs = rows * Vector3d(tangent.position.x(), tangent.position.y(), focal_px);
      const Vector2d slope =
          (cs[0] * rows.row(1).head<2>() - cs[1] * rows.row(0).head<2>()).transpose() / cs.squaredNorm();
      tangent.px_per_rad = 1.0 / slope.norm();
      const double sign = side == 0 ? -1.0 : 1.0;
      const Vector2d outwards = sign * slope.normalized();
      const double error_px = ErrorPx(camera, pair, side, tangent.position, outwards, time_s);
      tangent.angle_rad = angles[side] + sign * (error_px + dilation_px(camera, time_s)) / tangent.px_per_rad;
      tangent.sigma_px = 0.2;
      tangent.sight_in_world = assumed.transpose() * in_cam.normalized();
      tangent.is_seen_by_other = true;
      if (tangent.px_per_rad < TangentOptions{}.least_px_per_rad) continue;
      found.of_other[camera == pair.a ? pair.b : pair.a][side] = tangent;
    }
  }
  return found;
}

FrameTangencies TangentFootage::FrameAt(double stamp_s) const {
  std::vector<CameraTangents> tangents;
  for (core::CameraIndex i = 0; i < rig_.cameras.size(); ++i) tangents.push_back(TangentsOf(i, stamp_s));
  return CompareTangents(*pairs_, tangents, std::vector<core::SoftMask>(rig_.cameras.size()));
}

PoseChange ChangeOfSize(const EpipolarPairs& pairs, core::CameraIndex camera, const Vector3d& axis_in_cam,
                        const Vector3d& shift_in_world, double px) {
  const UndistortedPlane& plane = pairs.plane(camera);
  const double distance_mm = (pairs.workspace_mm().center() - plane.camera().center_in_world()).norm();
  const auto squares = ShiftSquares(plane.camera(), plane.focal_px(), distance_mm);
  PoseChange change;
  change << axis_in_cam / plane.focal_px(), shift_in_world * distance_mm / plane.focal_px();
  return change * (px / std::sqrt(change.dot(squares * change)));
}

}  // namespace elbowroom::recon::testing
