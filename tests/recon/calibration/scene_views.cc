#include "tests/recon/calibration/scene_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "recon/calibration/planar_pose.h"
#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kLeastPoints = 8;

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

}  // namespace

TrueBoard::TrueBoard(const Board& board, const Vector3d& bend_mm) : surface(board) {
  for (int i = 0; i < surface.points(); ++i) points.push_back(surface.Bent(i, bend_mm));
}

double NormalNumber(Random* random) {
  // Box and Muller; the engine's own normal distribution differs between libraries.
  const double radius = std::sqrt(-2.0 * std::log(random->Uniform(1e-300, 1.0)));
  return radius * std::cos(random->Uniform(0.0, 2.0 * std::numbers::pi));
}

void AddNoiseTo(double noise_px, Random* random, BoardSighting* sighting) {
  for (SightedPoint& point : sighting->points)
    point.pixel += noise_px * Vector2d(NormalNumber(random), NormalNumber(random));
}

BoardSighting Look(const core::CameraModel& camera, const RigidTransform& world_from_board,
                   const std::vector<Vector3d>& points, double sigma_px) {
  constexpr double kMostSlant = 0.26;  // cosine of 75 degrees
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
  if (half.points.size() >= kLeastPoints) *sighting = half;
}

Fault DrawFault(double share, Random* random) {
  constexpr std::array<Fault, 4> kFaults = {Fault::kMirrored, Fault::kConfused, Fault::kPointsShifted,
                                            Fault::kViewShifted};
  return random->Chance(share) ? kFaults[static_cast<std::size_t>(random->Whole(0, 3))] : Fault::kNone;
}

void Disturb(Fault fault, Random* random, BoardSighting* sighting) {
  if (fault == Fault::kConfused) ConfuseNumbers(random, sighting);
  if (fault == Fault::kPointsShifted) ShiftPoints(0.4, random, sighting);
  if (fault == Fault::kViewShifted) ShiftPoints(1.0, random, sighting);
}

RigidTransform MirroredFor(const core::CameraModel& camera, const RigidTransform& world_from_board,
                           const Vector3d& center_in_board) {
  return camera.cam_from_world().Inverse() *
         Flipped(camera.cam_from_world() * world_from_board, center_in_board);
}

void NumberFromOtherEnd(const BoardSurface& surface, BoardSighting* sighting) {
  for (SightedPoint& point : sighting->points)
    point.point = surface.half_turn()[static_cast<std::size_t>(point.point)];
  std::ranges::sort(sighting->points, {}, &SightedPoint::point);
}

RigidTransform DrawLensPhoto(const core::CameraModel& camera, const TrueBoard& board, Random* random) {
  constexpr double kDegree = std::numbers::pi / 180.0, kLeastShown = 0.4;
  for (;;) {
    const Vector2d at(random->Uniform(0.2, 0.8) * camera.width_px(),
                      random->Uniform(0.2, 0.8) * camera.height_px());
    const std::optional<Vector2d> sight = camera.NormalisedFromPixel(at);
    const double tilt_axis = random->Uniform(0.0, 2.0 * std::numbers::pi);
    const double tilt = kDegree * random->Uniform(15.0, 50.0);
    const double roll = random->Uniform(-std::numbers::pi, std::numbers::pi);
    const double share = random->Uniform(0.8, 1.5);
    if (!sight) continue;
    RigidTransform cam_from_board;
    cam_from_board.rotation =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), sight->homogeneous()).toRotationMatrix() *
        RotationFromVector(tilt * Vector3d(std::cos(tilt_axis), std::sin(tilt_axis), 0.0)) *
        RotationFromVector({0.0, 0.0, roll}) * RotationFromVector({std::numbers::pi, 0.0, 0.0});
    const double length_mm = 2.0 * std::abs(board.surface.center().x());
    const double distance_mm =
        camera.calibration().camera_matrix(0, 0) * length_mm / (share * camera.width_px());
    cam_from_board.translation_mm =
        distance_mm * sight->homogeneous().normalized() - cam_from_board.rotation * board.surface.center();
    const RigidTransform world_from_board = camera.cam_from_world().Inverse() * cam_from_board;
    const std::size_t shown = Look(camera, world_from_board, board.points, 1.0).points.size();
    if (static_cast<double>(shown) >= kLeastShown * static_cast<double>(board.points.size()))
      return world_from_board;
  }
}

}  // namespace elbowroom::recon
