#include "core/mesh_queries/mesh_ray.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace elbowroom::core {
namespace {

using Eigen::Vector3d;

// Rays through the edge of a triangle count as through both of its neighbours: the barycentric coordinates
// may be below zero by what rounding makes of them.
constexpr double kRounding = 1e-12;
// A tree of 2^31 triangles is about half as deep; each level leaves one node waiting.
constexpr std::size_t kDeepest = 64;

// Where a ray enters boxes.
class Slabs {
 public:
  explicit Slabs(const MeshRay& ray)
      : ray_(ray), per_direction_(ray.direction.cwiseInverse()), origin_norm_(ray.origin.norm()) {}

  // `from` if it starts inside; infinity if it misses the box, or comes to it behind `to`. The box is made
  // larger by the share of its size that rounding may take from it.
  [[nodiscard]] double Entry(const Eigen::AlignedBox3d& box, double to) const {
    const double slack =
        kRounding * (box.min().cwiseAbs().maxCoeff() + box.max().cwiseAbs().maxCoeff() + origin_norm_);
    double enter = ray_.from, leave = to;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double low = box.min()[i] - slack - ray_.origin[i], high = box.max()[i] + slack - ray_.origin[i];
      if (ray_.direction[i] == 0.0) {
        if (low > 0.0 || high < 0.0) return kInfinity;
        continue;
      }
      const double at_low = low * per_direction_[i], at_high = high * per_direction_[i];
      enter = std::max(enter, std::min(at_low, at_high));
      leave = std::min(leave, std::max(at_low, at_high));
    }
    return enter <= leave ? enter : kInfinity;
  }

 private:
  const MeshRay& ray_;
  Vector3d per_direction_;
  double origin_norm_;
};

// Visits the nearer child first, and leaves out what begins behind the nearest triangle so far; with `is_any`
// it ends with that triangle.
std::optional<MetTriangle> Meet(const TriangleTree& tree, const MeshRay& ray, bool is_any) {
  if (tree.nodes().empty()) return std::nullopt;
  const Slabs slabs(ray);
  const TriangleMesh& mesh = tree.mesh();
  const auto corner = [&](std::uint32_t triangle, std::size_t i) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][i])];
  };
  std::optional<MetTriangle> met;
  double to = ray.to;
  std::array<std::pair<double, std::uint32_t>, kDeepest> waiting;
  std::size_t count = 0;
  const auto wait = [&](double enter, std::uint32_t node) {
    if (enter < kInfinity) waiting[count++] = {enter, node};
  };
  wait(slabs.Entry(tree.nodes()[0].box, to), 0);
  while (count > 0) {
    const auto [enter, index] = waiting[--count];
    if (enter > to) continue;
    const TriangleTree::Node& node = tree.nodes()[index];
    if (node.left != 0) {
      std::pair far{slabs.Entry(tree.nodes()[node.left].box, to), node.left};
      std::pair near{slabs.Entry(tree.nodes()[node.left + 1].box, to), node.left + 1};
      if (far.first < near.first) std::swap(far, near);
      wait(far.first, far.second);
      wait(near.first, near.second);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const std::uint32_t triangle = tree.order()[i];
      const std::optional<double> at = MeetTriangle(ray.origin, ray.direction, corner(triangle, 0),
                                                    corner(triangle, 1), corner(triangle, 2));
      if (!at || *at < ray.from || *at > to) continue;
      if (is_any) return MetTriangle{triangle, *at};
      if (met && *at == met->at && triangle > met->triangle) continue;
      met = {triangle, *at};
      to = *at;
    }
  }
  return met;
}

}  // namespace

std::optional<MetTriangle> FirstMet(const TriangleTree& tree, const MeshRay& ray) {
  return Meet(tree, ray, false);
}

bool MeetsAny(const TriangleTree& tree, const MeshRay& ray) { return Meet(tree, ray, true).has_value(); }

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

}  // namespace elbowroom::core
