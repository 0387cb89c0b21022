#include "app/control/picking/pick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/infinity.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

// Rays through the edge of a triangle count as through both of its neighbours: the barycentric coordinates
// may be below zero by what rounding makes of them.
constexpr double kRounding = 1e-12;

// A ray in the frame of a mesh. Rotations keep lengths, so distances are those in world.
struct RayInPart {
  Vector3d origin;
  Vector3d direction;
};

// Where the ray enters the box, 0 if it starts inside; infinity if it misses it. The box is made larger by
// the share of its size that rounding may take from it.
double Entry(const Eigen::AlignedBox3d& box, const RayInPart& ray) {
  const double slack =
      kRounding * (box.min().cwiseAbs().maxCoeff() + box.max().cwiseAbs().maxCoeff() + ray.origin.norm());
  double enter = 0.0, leave = core::kInfinity;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double low = box.min()[i] - slack - ray.origin[i], high = box.max()[i] + slack - ray.origin[i];
    if (ray.direction[i] == 0.0) {
      if (low > 0.0 || high < 0.0) return core::kInfinity;
      continue;
    }
    const double at_low = low / ray.direction[i], at_high = high / ray.direction[i];
    enter = std::max(enter, std::min(at_low, at_high));
    leave = std::min(leave, std::max(at_low, at_high));
  }
  return enter <= leave ? enter : core::kInfinity;
}

std::array<Vector3d, 3> CornersOf(const core::TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices_mm[static_cast<std::size_t>(a)], mesh.vertices_mm[static_cast<std::size_t>(b)],
          mesh.vertices_mm[static_cast<std::size_t>(c)]};
}

struct Met {
  double distance_mm = core::kInfinity;
  std::uint32_t triangle = 0;
};

// Visits the nearer child first, and leaves out what begins behind the nearest triangle so far.
Met FirstMet(const core::TriangleTree& tree, const RayInPart& ray, double from_mm, double enough_mm) {
  Met met{enough_mm, 0};
  if (tree.nodes().empty()) return {};
  std::vector<std::pair<double, std::uint32_t>> waiting{{Entry(tree.nodes()[0].box, ray), 0}};
  bool is_found = false;
  while (!waiting.empty()) {
    const auto [enter, index] = waiting.back();
    waiting.pop_back();
    if (enter > met.distance_mm) continue;
    const core::TriangleTree::Node& node = tree.nodes()[index];
    if (node.left != 0) {
      std::pair left{Entry(tree.nodes()[node.left].box, ray), node.left};
      std::pair right{Entry(tree.nodes()[node.left + 1].box, ray), node.left + 1};
      if (left.first < right.first) std::swap(left, right);
      for (const auto& child : {left, right})
        if (child.first <= met.distance_mm && child.first < core::kInfinity) waiting.push_back(child);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const std::uint32_t triangle = tree.order()[i];
      const auto [a, b, c] = CornersOf(tree.mesh(), triangle);
      const std::optional<double> at = MeetTriangle(ray.origin, ray.direction, a, b, c);
      if (!at || *at < from_mm || *at > met.distance_mm) continue;
      if (*at == met.distance_mm && (!is_found || triangle > met.triangle)) continue;
      met = {*at, triangle};
      is_found = true;
    }
  }
  return is_found ? met : Met{};
}

}  // namespace

PickRay RayThrough(const recon::SceneView& view, const Eigen::Vector2d& pixel) {
  return {view.EyeInWorld(), (view.cam_from_world.rotation.transpose() * view.RayInCam(pixel)).normalized()};
}

std::optional<double> MeetTriangle(const Vector3d& origin, const Vector3d& direction, const Vector3d& a,
                                   const Vector3d& b, const Vector3d& c) {
  // origin + t direction = a + u ab + v ac, solved by Cramer's rule.
  const Vector3d ab = b - a, ac = c - a, across = direction.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0.0) return std::nullopt;
  const Vector3d from_a = origin - a;
  const double u = from_a.dot(across) / determinant;
  if (!(u >= -kRounding && u <= 1.0 + kRounding)) return std::nullopt;
  const Vector3d up = from_a.cross(ab);
  const double v = direction.dot(up) / determinant;
  if (!(v >= -kRounding && u + v <= 1.0 + kRounding)) return std::nullopt;
  const double t = ac.dot(up) / determinant;
  return t >= 0.0 ? std::optional(t) : std::nullopt;
}

std::optional<Pick> PickPart(std::span<const PickablePart> parts, const PickRay& ray, double from_mm) {
  std::optional<Pick> pick;
  for (core::PartIndex i = 0; i < parts.size(); ++i) {
    const PickablePart& part = parts[i];
    if (part.tree == nullptr) continue;
    const core::RigidTransform part_from_world = part.world_from_part.Inverse();
    const RayInPart in_part{part_from_world * ray.origin_in_world,
                            part_from_world.rotation * ray.direction_in_world};
    const Met met = FirstMet(*part.tree, in_part, from_mm, pick ? pick->distance_mm : core::kInfinity);
    if (met.distance_mm == core::kInfinity || (pick && met.distance_mm >= pick->distance_mm)) continue;
    const auto [a, b, c] = CornersOf(part.tree->mesh(), met.triangle);
    pick = {i, met.triangle, met.distance_mm, ray.origin_in_world + met.distance_mm * ray.direction_in_world,
            part.world_from_part.rotation * (b - a).cross(c - a).normalized()};
  }
  return pick;
}

}  // namespace elbowroom::control
