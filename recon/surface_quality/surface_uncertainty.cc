#include "recon/surface_quality/surface_uncertainty.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "recon/calibration/lens_projection.h"
#include "recon/calibration/pixel_response.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"
#include "recon/surface_quality/bounding_edges.h"

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Of a value that is anywhere within one pixel: 1 / sqrt(12).
constexpr double kWithinPixelSigmaPx = 0.28867513459481287;
// A lens that enlarges areas by less than this share of what it does in its middle is near its fold, where it
// changes too fast for a table.
constexpr double kLeastArea = 0.25;

// The rays (u, v) that a camera has in its picture.
Eigen::AlignedBox2d RaysOf(const core::CameraModel& camera) {
  constexpr int kSteps = 32;
  Eigen::AlignedBox2d box;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Vector2d share(static_cast<double>(i) / kSteps, static_cast<double>(j) / kSteps);
      const Vector2d pixel =
          share.cwiseProduct(Vector2d(camera.width_px(), camera.height_px())).array() - 0.5;
      if (const auto uv = camera.NormalisedFromPixel(pixel)) box.extend(*uv);
    }
  }
  return box;
}

// The coefficients of the polynomial of second degree through three points. It is what the covariance is: the
// pixel's derivative by a parameter has a part that doesn't depend on depth and one that falls with it.
std::array<Matrix2d, 3> Through(const std::array<double, 3>& q, const std::array<Matrix2d, 3>& at) {
  const Matrix2d slope01 = (at[1] - at[0]) / (q[1] - q[0]);
  const Matrix2d slope12 = (at[2] - at[1]) / (q[2] - q[1]);
  const Matrix2d bend = (slope12 - slope01) / (q[2] - q[0]);
  const Matrix2d slope = slope01 - bend * (q[0] + q[1]);
  return {at[0] - slope * q[0] - bend * q[0] * q[0], slope, bend};
}

}  // namespace

SurfaceUncertainty::SurfaceUncertainty(const core::Rig& rig, core::RigErrors errors)
    : errors_(rig, std::move(errors)) {
  Eigen::Index first = 0;
  for (const core::CameraModel& camera : rig.cameras) {
    const ParameterBlock block{static_cast<int>(first), LensParametersOf(camera.calibration()).count()};
    const double distance_mm = (camera.center_in_world() - rig.workspace_mm.center()).norm();
    tables_.push_back(TableOf(camera,
                              errors_.errors().covariance.block(first, first, block.size(), block.size()),
                              std::max(distance_mm, 1.0)));
    first += block.size();
  }
}

SurfaceUncertainty::Table SurfaceUncertainty::TableOf(const core::CameraModel& camera,
                                                      const Eigen::MatrixXd& covariance, double distance_mm) {
  const LensParameters lens = LensParametersOf(camera.calibration());
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  const core::RigidTransform world_from_cam = cam_from_world.Inverse();
  const Eigen::AlignedBox2d rays = RaysOf(camera);
  Table table{cam_from_world, Vector2d::Zero(), Vector2d::Ones(), {}, {}};
  if (rays.isEmpty()) return table;
  table.first = rays.min();
  table.step = rays.sizes().cwiseMax(1e-9) / (kNodes - 1);
  const Matrix2d in_middle = camera.calibration().camera_matrix.topLeftCorner<2, 2>();
  const std::array<double, 3> depths_mm{0.5 * distance_mm, distance_mm, 2.0 * distance_mm};
  for (int row = 0; row < kNodes; ++row) {
    for (int column = 0; column < kNodes; ++column) {
      const Vector2d uv = table.first + table.step.cwiseProduct(Vector2d(column, row));
      Node node{Matrix2d::Zero(), {}};
      std::array<Matrix2d, 3> covariance_px2;
      std::array<double, 3> q{};
      bool is_usable = true;
      for (std::size_t i = 0; i < 3 && is_usable; ++i) {
        const Vector3d x_in_world = world_from_cam * (depths_mm[i] * uv.homogeneous());
        const auto pixel = PixelResponseAt(lens, cam_from_world, x_in_world);
        is_usable = pixel.has_value();
        if (!is_usable) break;
        const Matrix2d by_uv = depths_mm[i] * (pixel->by_x_in_world * world_from_cam.rotation).leftCols<2>();
        is_usable = by_uv.determinant() > kLeastArea * in_middle.determinant();
        if (!is_usable) break;
        node.inverse_transposed = by_uv.inverse().transpose();
        covariance_px2[i] = pixel->by_parameters * covariance * pixel->by_parameters.transpose();
        q[i] = 1.0 / depths_mm[i];
      }
      if (is_usable) node.covariance_px2 = Through(q, covariance_px2);
      table.nodes.push_back(node);
      table.is_usable.push_back(is_usable);
    }
  }
  return table;
}

// Bilinear between four nodes.
std::optional<SurfaceUncertainty::Node> SurfaceUncertainty::NodeAt(const Table& table, const Vector2d& uv) {
  if (table.nodes.empty()) return std::nullopt;
  const Vector2d place = (uv - table.first).cwiseQuotient(table.step);
  if (!(place.minCoeff() >= 0.0 && place.maxCoeff() <= kNodes - 1)) return std::nullopt;
  const int x = std::min(static_cast<int>(place.x()), kNodes - 2);
  const int y = std::min(static_cast<int>(place.y()), kNodes - 2);
  const double right = place.x() - x, low = place.y() - y;
  Node sum{Matrix2d::Zero(), {Matrix2d::Zero(), Matrix2d::Zero(), Matrix2d::Zero()}};
  for (const auto& [i, j, weight] :
       {std::tuple{x, y, (1.0 - right) * (1.0 - low)}, std::tuple{x + 1, y, right * (1.0 - low)},
        std::tuple{x, y + 1, (1.0 - right) * low}, std::tuple{x + 1, y + 1, right * low}}) {
    const auto at = static_cast<std::size_t>(j * kNodes + i);
    if (!table.is_usable[at]) return std::nullopt;
    sum.inverse_transposed += weight * table.nodes[at].inverse_transposed;
    for (std::size_t k = 0; k < 3; ++k) sum.covariance_px2[k] += weight * table.nodes[at].covariance_px2[k];
  }
  return sum;
}

// With A = q J (1 0 -u; 0 1 -v) the pixel's derivative by the point in the camera's frame, and the cone's
// normal N across the ray, A^T n is parallel to N for n along m = J^-T (N_x, N_y); then |A^T n| = q / |m|. So
// a contour that is off by e px shifts the cone by w e, w = |m| / q, and parameters by w sqrt(n^T C n).
double SurfaceUncertainty::ExpandedMm(core::CameraIndex camera, const Vector3d& normal_in_world,
                                      const Vector3d& x_in_world, bool is_located) const {
  const Table& table = tables_[camera];
  const Vector3d x_in_cam = table.cam_from_world * x_in_world;
  if (!(x_in_cam.z() > 0.0)) return 0.0;
  const std::optional<Node> node = NodeAt(table, x_in_cam.hnormalized());
  if (!node) return errors_.OfCone(camera, normal_in_world, x_in_world, is_located).ExpandedMm();
  const double q = 1.0 / x_in_cam.z();
  const Vector3d normal_in_cam = table.cam_from_world.rotation * normal_in_world;
  const Vector2d m = node->inverse_transposed * normal_in_cam.head<2>();
  const Matrix2d covariance_px2 =
      node->covariance_px2[0] + q * node->covariance_px2[1] + q * q * node->covariance_px2[2];
  const double sigma_px = is_located ? errors_.errors().boundary_sigma_px : kWithinPixelSigmaPx;
  const double variance = std::max(0.0, m.dot(covariance_px2 * m)) + m.squaredNorm() * sigma_px * sigma_px;
  return core::kCoverageFactor * std::sqrt(variance) / q;
}

SurfaceValues SurfaceUncertainty::Of(const VisualHull& hull, const HullView& picture,
                                     const ViewRays& rays) const {
  std::vector<bool> is_located;
  for (const auto& silhouette : hull.silhouettes())
    is_located.push_back(!silhouette->soft_mask().levels.empty());
  return ValuesOf(
      hull, picture, rays,
      [&](core::CameraIndex bounding, const auto& x_in_world, const auto& normal_in_world) {
        return static_cast<float>(ExpandedMm(bounding, normal_in_world, x_in_world, is_located[bounding]));
      });
}

}  // namespace elbowroom::recon
