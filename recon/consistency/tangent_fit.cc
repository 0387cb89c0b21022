#include "recon/consistency/tangent_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace elbowroom::recon {
namespace {

constexpr std::size_t kFewestPoints = 5;
constexpr std::size_t kMostPoints = 64;
constexpr double kUnevenSigmas = 3.0;

// Boundary points as (along the tangent, inwards negative), in px, from the vertex.
struct NearPoints {
  std::array<Eigen::Vector2d, kMostPoints> at;
  std::size_t count = 0;
};

// Walks along the boundary from the vertex, both ways, as far as it stays near the tangent.
NearPoints PointsNear(const Contour& contour, std::uint32_t vertex, const Eigen::Vector2d& outwards,
                      double plane_per_px, const TangentOptions& options) {
  const Eigen::Vector2d along(-outwards.y(), outwards.x());
  const Eigen::Vector2d& origin = contour.vertices[vertex];
  NearPoints near;
  near.at[near.count++] = Eigen::Vector2d::Zero();
  for (const bool forwards : {true, false}) {
    const std::size_t most = forwards ? kMostPoints / 2 : kMostPoints;
    std::uint32_t next = vertex;
    while (near.count < most) {
      next = forwards ? contour.edges[contour.edge_from[next]].to : contour.edges[contour.edge_to[next]].from;
      if (next == vertex) break;
      const Eigen::Vector2d step = (contour.vertices[next] - origin) / plane_per_px;
      const Eigen::Vector2d point(step.dot(along), step.dot(outwards));
      if (-point.y() > options.depth_px || std::abs(point.x()) > options.reach_px) break;
      near.at[near.count++] = point;
    }
  }
  return near;
}

}  // namespace

std::optional<OutermostFit> FitOutermost(const Contour& contour, std::uint32_t vertex,
                                         const Eigen::Vector2d& outwards, double plane_per_px,
                                         const TangentOptions& options) {
  const NearPoints near = PointsNear(contour, vertex, outwards, plane_per_px, options);
  if (near.count < kFewestPoints) return std::nullopt;
  double least = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < near.count; ++i) {
    least = std::min(least, near.at[i].x());
    largest = std::max(largest, near.at[i].x());
  }
  // The fit runs over s = (along - middle) / half, in [-1, 1].
  const double half = 0.5 * (largest - least), middle = 0.5 * (largest + least);
  if (half <= 0.0) return std::nullopt;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (std::size_t i = 0; i < near.count; ++i) {
    const double s = (near.at[i].x() - middle) / half;
    const Eigen::Vector3d basis(1.0, s, s * s);
    normal += basis * basis.transpose();
    right += near.at[i].y() * basis;
    squares += near.at[i].y() * near.at[i].y();
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() < 1e-9) return std::nullopt;
  const Eigen::Vector3d c = solver.solve(right);
  // The outermost point of the parabola; of one that isn't curved outwards, its outermost end.
  double s = c[1] > 0.0 ? 1.0 : -1.0;
  if (c[2] < 0.0) s = std::clamp(-0.5 * c[1] / c[2], -1.0, 1.0);
  const Eigen::Vector3d basis(1.0, s, s * s);

  // Neighbouring points share their noise: so many of them count as one.
  const double per_px = static_cast<double>(near.count) / (2.0 * half);
  const double alike = std::max(1.0, options.correlation_px * per_px);
  const double points = static_cast<double>(near.count);
  const double rms_px = std::sqrt(std::max(0.0, squares - c.dot(right)) / (points - 3.0));
  if (rms_px > kUnevenSigmas * options.boundary_sigma_px) return std::nullopt;
  const double noise_px = std::max(rms_px, options.boundary_sigma_px);
  // More can't be alike than there are: the variance of all points' mean is that of one point at most, and
  // the parabola's shape makes it larger by what basis' normal^-1 basis exceeds 1 / points.
  const double variance = basis.dot(solver.solve(basis)) * std::min(alike, points);
  return OutermostFit{middle + half * s, basis.dot(c), noise_px * std::sqrt(variance)};
}

}  // namespace elbowroom::recon
