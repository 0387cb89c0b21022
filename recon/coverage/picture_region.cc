#include "recon/coverage/picture_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The point of the line from the principal point to a border pixel that is the farthest one with a ray.
Vector2d FarthestRay(const core::CameraModel& camera, const Vector2d& border_px) {
  if (const std::optional<Vector2d> ray = camera.NormalisedFromPixel(border_px)) return *ray;
  const Eigen::Matrix3d& k = camera.calibration().camera_matrix;
  const Vector2d middle_px(k(0, 2), k(1, 2));
  constexpr int kHalvings = 40;
  double with = 0.0, without = 1.0;
  Vector2d farthest = Vector2d::Zero();
  for (int i = 0; i < kHalvings; ++i) {
    const double share = 0.5 * (with + without);
    const auto ray = camera.NormalisedFromPixel(middle_px + share * (border_px - middle_px));
    if (ray) farthest = *ray;
    (ray ? with : without) = share;
  }
  return farthest;
}

std::vector<Vector3d> BorderRays(const core::CameraModel& camera) {
  constexpr int kEdgesOfABentSide = 8;
  const int edges = camera.is_ideal() ? 1 : kEdgesOfABentSide;
  const double right = camera.width_px() - 0.5, bottom = camera.height_px() - 0.5;
  const std::array<Vector2d, 5> corners = {
      Vector2d(-0.5, -0.5), {right, -0.5}, {right, bottom}, {-0.5, bottom}, {-0.5, -0.5}};
  std::vector<Vector3d> rays;
  for (std::size_t side = 0; side < 4; ++side) {
    for (int i = 0; i < edges; ++i) {
      const double share = static_cast<double>(i) / edges;
      const Vector2d pixel = (1.0 - share) * corners[side] + share * corners[side + 1];
      rays.push_back(FarthestRay(camera, pixel).homogeneous());
    }
  }
  return rays;
}

}  // namespace

PictureRegion::PictureRegion(const core::CameraModel& camera) {
  const std::vector<Vector3d> rays = BorderRays(camera);
  double area = 0.0;  // twice that of the polygon; negative where the camera matrix mirrors
  for (std::size_t i = 0; i < rays.size(); ++i) area += rays[i].cross(rays[(i + 1) % rays.size()]).z();
  const double sense = area < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vector3d& begin = rays[i];
    const Vector3d& end = rays[(i + 1) % rays.size()];
    const Vector3d inward = sense * begin.cross(end);
    if (!(inward.norm() > 0.0)) continue;  // two corners of a strong lens may fall together
    const Vector3d unit = inward.normalized();
    edges_.push_back({begin, unit, sense * unit.cross(begin), sense * end.cross(unit)});
  }
  core::Require(edges_.size() >= 3, "a picture has a border");
  constexpr double kRounding = 1e-9;
  for (const Edge& edge : edges_)
    for (const Vector3d& ray : rays) is_convex_ = is_convex_ && edge.inward.dot(ray) > -kRounding;
}

bool PictureRegion::Holds(const Vector3d& x_in_cam) const {
  if (is_convex_)
    return std::ranges::all_of(edges_, [&](const Edge& edge) { return edge.inward.dot(x_in_cam) >= 0.0; });
  if (!(x_in_cam.z() > 0.0)) return false;
  const Vector2d x = x_in_cam.hnormalized();
  bool is_inside = false;  // an odd number of edges lies to the right
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Vector3d& a = edges_[i].begin;
    const Vector3d& b = edges_[(i + 1) % edges_.size()].begin;
    if ((a.y() > x.y()) == (b.y() > x.y())) continue;
    if (x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) is_inside = !is_inside;
  }
  return is_inside;
}

bool PictureRegion::SurelyHoldsBall(const Vector3d& center_in_cam, double radius_mm) const {
  return center_in_cam.z() > 0.0 && std::ranges::all_of(edges_, [&](const Edge& edge) {
           return edge.inward.dot(center_in_cam) >= radius_mm;
         });
}

Stretch PictureRegion::CutConvex(const RayInCam& ray, Stretch within) const {
  for (const Edge& edge : edges_) {
    const double at_start = edge.inward.dot(ray.start), growth = edge.inward.dot(ray.along);
    if (growth > 0.0) {
      within.begin = std::max(within.begin, -at_start / growth);
    } else if (growth < 0.0) {
      within.end = std::min(within.end, -at_start / growth);
    } else if (at_start < 0.0) {
      within.end = within.begin;
    }
  }
  return within;
}

// A region that isn't convex: the ray is divided where it crosses the border, and each piece is asked at its
// middle.
void PictureRegion::Cut(const RayInCam& ray, const Stretch& within, RayStretches* seen) const {
  seen->Clear();
  if (within.is_empty()) return;
  if (is_convex_) {
    seen->Append(CutConvex(ray, within));
    return;
  }
  constexpr std::size_t kMostCuts = 64;
  std::array<double, kMostCuts> cuts;
  std::size_t count = 0;
  cuts[count++] = within.begin;
  for (const Edge& edge : edges_) {
    const double t = -edge.inward.dot(ray.start) / edge.inward.dot(ray.along);
    if (!(t > within.begin && t < within.end)) continue;
    const Vector3d x = ray.At(t);
    if (x.dot(edge.after_begin) >= 0.0 && x.dot(edge.before_end) >= 0.0 && count + 1 < kMostCuts)
      cuts[count++] = t;
  }
  cuts[count++] = within.end;
  std::sort(cuts.begin(), cuts.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t i = 0; i + 1 < count; ++i)
    if (Holds(ray.At(0.5 * (cuts[i] + cuts[i + 1])))) seen->Append({cuts[i], cuts[i + 1]});
}

}  // namespace elbowroom::recon
