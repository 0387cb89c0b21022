#include "recon/calibration/rig_uncertainty.h"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "recon/calibration/point_response.h"

namespace elbowroom::recon {
namespace {

// Nodes of one plane of the map.
void FillPlane(const RigUncertainty& rig, int z, UncertaintyMap* map) {
  for (int y = 0; y < map->nodes.y(); ++y) {
    for (int x = 0; x < map->nodes.x(); ++x) {
      const Eigen::Vector3d at = map->first_node_mm + map->edge_mm * Eigen::Vector3d(x, y, z);
      const std::optional<PointUncertainty> uncertainty = rig.At(at);
      UncertaintyMap::Node node;
      node.is_known = uncertainty.has_value();
      node.cameras = static_cast<std::uint8_t>(
          std::min(255, uncertainty ? uncertainty->cameras : rig.CamerasSeeing(at)));
      if (uncertainty) node.sigma_mm = static_cast<float>(uncertainty->sigma_mm());
      const auto place = (static_cast<std::size_t>(z) * static_cast<std::size_t>(map->nodes.y()) +
                          static_cast<std::size_t>(y)) *
                             static_cast<std::size_t>(map->nodes.x()) +
                         static_cast<std::size_t>(x);
      map->values[place] = node;
    }
  }
}

std::vector<core::CameraModel> ModelsOf(const CalibrationResult& result) {
  std::vector<core::CameraModel> models;
  for (const CalibratedCamera& camera : result.cameras) models.emplace_back(camera.calibration);
  return models;
}

}  // namespace

bool IsInPicture(const core::CameraModel& camera, const Eigen::Vector3d& x_in_world) {
  const std::optional<Eigen::Vector2d> pixel = camera.Project(x_in_world);
  return pixel && pixel->x() >= -0.5 && pixel->y() >= -0.5 && pixel->x() <= camera.width_px() - 0.5 &&
         pixel->y() <= camera.height_px() - 0.5;
}

double PointUncertainty::sigma_mm() const { return std::sqrt(covariance_mm2.trace()); }

RigUncertainty::RigUncertainty(std::span<const core::CameraModel> cameras, Eigen::MatrixXd covariance,
                               double noise_px)
    : covariance_(std::move(covariance)), noise_px_(noise_px) {
  core::Require(noise_px > 0.0 && std::isfinite(noise_px), "the noise of a pixel is positive");
  int parameters = 0;
  for (const core::CameraModel& camera : cameras) {
    const LensParameters lens = LensParametersOf(camera.calibration());
    cameras_.push_back({camera, lens, {parameters, lens.count()}});
    parameters += cameras_.back().parameters.size();
  }
  if (covariance_.size() == 0) covariance_ = Eigen::MatrixXd::Zero(parameters, parameters);
  core::Require(covariance_.rows() == parameters && covariance_.cols() == parameters,
                "the covariance has a row for each parameter of the cameras");
  is_exact_ = covariance_.isZero(0.0);
}

RigUncertainty::RigUncertainty(const CalibrationResult& result, double noise_px)
    : RigUncertainty(ModelsOf(result), result.covariance, noise_px) {}

int RigUncertainty::CamerasSeeing(const Eigen::Vector3d& x_in_world) const {
  return static_cast<int>(
      std::ranges::count_if(cameras_, [&](const Camera& c) { return IsInPicture(c.model, x_in_world); }));
}

std::optional<PointResponse> RigUncertainty::ResponseAt(const Eigen::Vector3d& x_in_world,
                                                        int* seeing) const {
  PointResponse response(static_cast<int>(covariance_.rows()));
  *seeing = 0;
  for (const Camera& camera : cameras_) {
    if (!IsInPicture(camera.model, x_in_world)) continue;
    ++*seeing;
    response.Add(camera.lens, camera.model.cam_from_world(), camera.parameters, x_in_world);
  }
  if (*seeing < 2 || !response.Solve()) return std::nullopt;
  return response;
}

std::optional<PointUncertainty> RigUncertainty::At(const Eigen::Vector3d& x_in_world) const {
  PointUncertainty point;
  const std::optional<PointResponse> response = ResponseAt(x_in_world, &point.cameras);
  if (!response) return std::nullopt;
  point.covariance_mm2 = noise_px_ * noise_px_ * response->by_noise();
  if (is_exact_) return point;
  const auto& g = response->by_parameters();
  point.covariance_mm2 += (g * covariance_) * g.transpose();
  return point;
}

std::optional<Eigen::Matrix3Xd> RigUncertainty::ShiftByParameters(const Eigen::Vector3d& x_in_world) const {
  int seeing = 0;
  const std::optional<PointResponse> response = ResponseAt(x_in_world, &seeing);
  if (!response) return std::nullopt;
  return response->by_parameters();
}

double MapEdgeMm(const Eigen::AlignedBox3d& box_mm, double edge_mm, double most_nodes) {
  while (((box_mm.sizes() / edge_mm).array().floor() + 1.0).prod() > most_nodes) edge_mm *= 1.5;
  return edge_mm;
}

UncertaintyMap MapUncertainty(const RigUncertainty& rig, const Eigen::AlignedBox3d& workspace_mm,
                              double edge_mm, const core::Progress& progress, const std::stop_token& stop) {
  constexpr double kMostNodes = 5e7, kRounding = 1e-9;
  core::Require(edge_mm > 0.0 && std::isfinite(edge_mm), "the grid's edge is positive");
  core::Require(!workspace_mm.isEmpty(), "the workspace isn't empty");
  const Eigen::Vector3d counts = ((workspace_mm.sizes() / edge_mm).array() + kRounding).floor() + 1.0;
  core::Require(counts.prod() <= kMostNodes, "a map has 50,000,000 nodes at most");
  UncertaintyMap map{workspace_mm.min(), edge_mm, counts.cast<int>(), {}};
  map.values.resize(static_cast<std::size_t>(counts.prod()));
  constexpr int kPlanesAtOnce = 16;  // between two reports
  for (int from = 0; from < map.nodes.z(); from += kPlanesAtOnce) {
    core::ThrowIfStopped(stop, "uncertainty map");
    progress.Report(from, map.nodes.z(), "uncertainty map");
    tbb::parallel_for(from, std::min(from + kPlanesAtOnce, map.nodes.z()),
                      [&](int z) { FillPlane(rig, z, &map); });
  }
  progress.Report(map.nodes.z(), map.nodes.z(), "uncertainty map");
  return map;
}

}  // namespace elbowroom::recon
