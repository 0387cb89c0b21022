#include "recon/head_pose/cap_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector3d;

// In standard deviations. Wide: a start by one marker is some pixels off at the others.
constexpr double kWideScale = 100.0, kNarrowScale = 3.0;
constexpr std::size_t kMostStarts = 6;
constexpr double kOnePoseRad = 0.02;
constexpr double kAgreeingSigmas = 6.0;

std::vector<std::size_t> MarkersOfPoints(const CapSighting& sighting) {
  std::vector<std::size_t> markers;
  for (const SightedMarker& marker : sighting)
    for (const auto& corner : marker.corners)
      if (corner) markers.push_back(marker.marker);
  return markers;
}

std::vector<PosePoint> PointsOf(const Cap& cap, const CapSighting& sighting, double least_sigma_px) {
  const RigidTransform head_from_cap = cap.cap_from_head.Inverse();
  std::vector<PosePoint> points;
  for (const SightedMarker& marker : sighting) {
    const auto corners = CornersInCap(cap.markers[marker.marker]);
    for (std::size_t k = 0; k < 4; ++k)
      if (const auto& corner = marker.corners[k])
        points.push_back(
            {head_from_cap * corners[k], corner->pixel, 1.0 / std::hypot(corner->sigma_px, least_sigma_px)});
  }
  return points;
}

// Of one marker: its plane's points, where all four corners are there.
void AddStarts(const Cap& cap, const CapCamera& camera, const SightedMarker& sighted,
               std::vector<RigidTransform>* starts) {
  const CapMarker& marker = cap.markers[sighted.marker];
  const double h = 0.5 * marker.side_mm;
  const Vector3d in_marker[4] = {{-h, h, 0.0}, {h, h, 0.0}, {h, -h, 0.0}, {-h, -h, 0.0}};
  std::vector<PosePoint> points;
  std::vector<Eigen::Vector2d> normalised;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!sighted.corners[k]) return;
    const auto point = NormalisedPoint(camera.lens, sighted.corners[k]->pixel);
    if (!point) return;
    points.push_back({in_marker[k], sighted.corners[k]->pixel, 1.0});
    normalised.push_back(*point);
  }
  const RigidTransform marker_from_head = marker.cap_from_marker.Inverse() * cap.cap_from_head;
  for (const PlanarPose& pose : PlanarPosesOf(camera.lens, points, normalised))
    starts->push_back(camera.cam_from_world.Inverse() * pose.cam_from_board * marker_from_head);
}

bool AreOneMinimum(const RigidTransform& a, const RigidTransform& b) {
  return VectorFromRotation(a.rotation.transpose() * b.rotation).norm() < kOnePoseRad;
}

}  // namespace

CapProblem ProblemOf(const Cap& cap, std::span<const CapCamera> cameras,
                     std::span<const CapSighting> sightings, double least_sigma_px) {
  CapProblem problem;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (sightings[i].empty()) continue;
    problem.markers += static_cast<int>(sightings[i].size());
    problem.views.push_back(
        {&cameras[i].lens, cameras[i].cam_from_world, PointsOf(cap, sightings[i], least_sigma_px)});
    problem.markers_of_points.push_back(MarkersOfPoints(sightings[i]));
  }
  return problem;
}

std::vector<RigidTransform> StartsOf(const Cap& cap, std::span<const CapCamera> cameras,
                                     std::span<const CapSighting> sightings) {
  std::vector<RigidTransform> starts;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    for (const SightedMarker& marker : sightings[i]) AddStarts(cap, cameras[i], marker, &starts);
  return starts;
}

std::vector<PoseFit> MinimaOf(const CapProblem& problem, std::span<const RigidTransform> starts) {
  std::vector<PoseFit> begun;
  for (const RigidTransform& start : starts)
    begun.push_back(FitBoardPose(problem.views, start, kWideScale, 2));
  std::ranges::sort(begun, {}, &PoseFit::cost);
  if (begun.size() > kMostStarts) begun.resize(kMostStarts);
  std::vector<PoseFit> minima;
  for (const PoseFit& start : begun) {
    const PoseFit wide = FitBoardPose(problem.views, start.rig_from_board, kWideScale);
    const PoseFit fit = FitBoardPose(problem.views, wide.rig_from_board, kNarrowScale);
    const bool is_known = std::ranges::any_of(minima, [&](PoseFit& known) {
      if (!AreOneMinimum(known.rig_from_board, fit.rig_from_board)) return false;
      if (fit.cost < known.cost) known = fit;
      return true;
    });
    if (!is_known) minima.push_back(fit);
  }
  std::ranges::sort(minima, {}, &PoseFit::cost);
  return minima;
}

CapEvidence EvidenceFor(const Cap& cap, const CapProblem& problem, const RigidTransform& world_from_head) {
  CapEvidence evidence;
  evidence.by_marker.assign(cap.markers.size(), Eigen::Matrix<double, 6, 3>::Zero());
  const RigidTransform world_from_cap = world_from_head * cap.cap_from_head.Inverse();
  for (std::size_t v = 0; v < problem.views.size(); ++v) {
    const PosedView& view = problem.views[v];
    for (std::size_t i = 0; i < view.points.size(); ++i) {
      const PosePoint& point = view.points[i];
      const std::size_t marker = problem.markers_of_points[v][i];
      ++evidence.corners_in_all;
      const Vector3d x_in_cam = view.cam_from_rig * (world_from_head * point.x_in_board);
      const auto projected = ProjectWithPointDerivative(*view.lens, x_in_cam);
      const auto middle =
          ProjectPoint(*view.lens, view.cam_from_rig *
                                       (world_from_cap * cap.markers[marker].cap_from_marker.translation_mm));
      if (!projected || !middle) continue;
      const double px2 = (projected->pixel - point.pixel).squaredNorm();
      const double inverse2 = point.inverse_sigma * point.inverse_sigma;
      const Eigen::Matrix<double, 2, 3> by_shift = projected->by_x_in_cam * view.cam_from_rig.rotation;
      const double place_px2 = 0.5 * cap.place_sigma_mm * cap.place_sigma_mm * by_shift.squaredNorm();
      if (px2 > kAgreeingSigmas * kAgreeingSigmas * (1.0 / inverse2 + place_px2)) continue;
      // x_in_world = R exp(w) x_in_head + t moves by -R [x_in_head] w + dt.
      Eigen::Matrix<double, 3, 6> by_pose;
      by_pose << -world_from_head.rotation * Hat(point.x_in_board), Eigen::Matrix3d::Identity();
      const Eigen::Matrix<double, 2, 6> j = by_shift * by_pose;
      evidence.information += inverse2 * j.transpose() * j;
      evidence.by_marker[marker] += inverse2 * j.transpose() * by_shift;
      // Two edges that move inwards by a pixel move their corner by about sqrt(2) along the diagonal.
      evidence.by_edges +=
          std::numbers::sqrt2 * inverse2 * j.transpose() * (*middle - projected->pixel).normalized();
      evidence.squared_sigmas += px2 * inverse2;
      evidence.unexplained += px2 / (1.0 / inverse2 + place_px2);
      evidence.squared_px2 += px2;
      ++evidence.corners;
    }
  }
  return evidence;
}

}  // namespace elbowroom::recon
