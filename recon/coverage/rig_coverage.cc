#include "recon/coverage/rig_coverage.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {

using Eigen::Vector3d;

double PixelWidthMm(const LensParameters& lens, const core::RigidTransform& cam_from_world,
                    const Vector3d& x_in_world) {
  const std::optional<ProjectedPoint> point = ProjectWithDerivatives(lens, cam_from_world * x_in_world);
  if (!point) return 0.0;
  // The smallest singular value of the derivative by a shift parallel to the picture, in px / mm.
  const Eigen::Matrix2d by_shift = point->by_x_in_cam.leftCols<2>();
  const double half_sum = 0.5 * by_shift.squaredNorm(), determinant = by_shift.determinant();
  const double largest2 =
      half_sum + std::sqrt(std::max(half_sum * half_sum - determinant * determinant, 0.0));
  const double smallest = std::abs(determinant) / std::sqrt(largest2);
  return smallest > 0.0 ? 1.0 / smallest : 0.0;
}

RigCoverage::RigCoverage(const CalibratedRig& rig, const CoverageOptions& options)
    : uncertainty_(rig.rig.cameras, rig.covariance, rig.noise_px),
      ball_hull_(rig.rig, options.rings),
      ball_radius_mm_(0.5 * options.ball_mm),
      abstains_(rig.rig.unseen == core::UnseenPolicy::kAbstain) {
  core::Require(options.ball_mm > 0.0 && std::isfinite(options.ball_mm), "the ball has a size");
  for (const core::CameraModel& camera : rig.rig.cameras)
    cameras_.push_back({camera, LensParametersOf(camera.calibration())});
}

CoverageNode RigCoverage::At(const Vector3d& x_in_world, BallHull::Scratch* scratch) const {
  CoverageNode node;
  std::size_t seeing = 0;
  double footprint_mm = 0.0;
  for (const Camera& camera : cameras_) {
    if (!IsInPicture(camera.model, x_in_world)) continue;
    ++seeing;
    footprint_mm =
        std::max(footprint_mm, PixelWidthMm(camera.lens, camera.model.cam_from_world(), x_in_world));
  }
  node.cameras = static_cast<std::uint8_t>(std::min<std::size_t>(seeing, 255));
  node.footprint_mm = static_cast<float>(footprint_mm);
  node.in_reach = abstains_ ? seeing > 0 : seeing == cameras_.size();
  if (seeing >= 2) {
    if (const std::optional<PointUncertainty> uncertainty = uncertainty_.At(x_in_world)) {
      node.sigma_mm = static_cast<float>(uncertainty->sigma_mm());
      node.has_sigma = true;
    }
  }
  if (!node.in_reach) return node;
  if (const auto volume = ball_hull_.At(x_in_world, ball_radius_mm_, scratch)) {
    node.phantom = static_cast<float>(std::clamp(volume->phantom_fraction(), 0.0, 1.0));
    node.has_phantom = true;
  }
  return node;
}

std::vector<CoverageNode> RigCoverage::At(std::span<const Vector3d> points_in_world,
                                          const core::Progress& progress, const std::stop_token& stop) const {
  constexpr std::size_t kNodesAtOnce = 8192;  // between two reports
  std::vector<CoverageNode> nodes(points_in_world.size());
  const auto total = static_cast<std::int64_t>(nodes.size());
  for (std::size_t from = 0; from < nodes.size(); from += kNodesAtOnce) {
    core::ThrowIfStopped(stop, "coverage");
    progress.Report(static_cast<std::int64_t>(from), total, "coverage");
    const tbb::blocked_range<std::size_t> range(from, std::min(from + kNodesAtOnce, nodes.size()), 16);
    tbb::parallel_for(range, [&](const tbb::blocked_range<std::size_t>& piece) {
      BallHull::Scratch scratch;
      for (std::size_t i = piece.begin(); i < piece.end(); ++i) nodes[i] = At(points_in_world[i], &scratch);
    });
  }
  progress.Report(total, total, "coverage");
  return nodes;
}

Vector3d CoverageGrid::PointAt(std::size_t node) const {
  const auto across = static_cast<std::size_t>(counts.x()), deep = static_cast<std::size_t>(counts.y());
  const std::size_t x = node % across, y = node / across % deep, z = node / across / deep;
  return first_mm +
         edge_mm * Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
}

std::size_t CoverageGrid::NodeAt(int x, int y, int z) const {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(counts.y()) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(counts.x()) +
         static_cast<std::size_t>(x);
}

std::vector<Vector3d> CoverageGrid::Points() const {
  std::vector<Vector3d> points(size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = PointAt(i);
  return points;
}

CoverageGrid GridOver(const Eigen::AlignedBox3d& box_mm, double edge_mm) {
  constexpr double kRounding = 1e-9;
  core::Require(edge_mm > 0.0 && std::isfinite(edge_mm), "the grid's edge is positive");
  core::Require(!box_mm.isEmpty(), "the box isn't empty");
  const Vector3d cells = ((box_mm.sizes() / edge_mm).array() + kRounding).floor();
  return {box_mm.min(), edge_mm, (cells.array() + 1.0).cast<int>()};
}

}  // namespace elbowroom::recon
