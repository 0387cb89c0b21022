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

struct Waiting {
  double enter;
  std::uint32_t node;
};

// Where a ray enters boxes that lie in `all`. They are made larger by the share of its size that rounding may
// take from them.
class Slabs {
 public:
  Slabs(const MeshRay& ray, const Eigen::AlignedBox3d& all)
      : per_direction_(ray.direction.cwiseInverse()), from_(ray.from) {
    const double slack =
        kRounding * (all.min().cwiseAbs().maxCoeff() + all.max().cwiseAbs().maxCoeff() + ray.origin.norm());
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double outwards = ray.direction[i] < 0.0 ? -slack : slack;
      near_origin_[i] = ray.origin[i] + outwards;
      far_origin_[i] = ray.origin[i] - outwards;
    }
  }

  // `from` if it starts inside; infinity if it misses the box, or comes to it behind `to`. Along an axis that
  // the ray runs across, both places are infinite, or NaN on a face itself, which the comparisons leave out.
  [[nodiscard]] double Entry(const Eigen::AlignedBox3d& box, double to) const {
    double enter = from_, leave = to;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const bool is_back = per_direction_[i] < 0.0;
      const double near = ((is_back ? box.max() : box.min())[i] - near_origin_[i]) * per_direction_[i];
      const double far = ((is_back ? box.min() : box.max())[i] - far_origin_[i]) * per_direction_[i];
      enter = near > enter ? near : enter;
      leave = far < leave ? far : leave;
    }
    return enter <= leave ? enter : kInfinity;
  }

 private:
  Vector3d per_direction_;
  Vector3d near_origin_;
  Vector3d far_origin_;
  double from_;
};

// Visits the nearer child first, and leaves out what begins behind the nearest triangle so far; with `is_any`
// it ends with that triangle.
std::optional<MetTriangle> Meet(const TriangleTree& tree, const MeshRay& ray, bool is_any) {
  if (tree.nodes().empty()) return std::nullopt;
  const Slabs slabs(ray, tree.nodes()[0].box);
  const TriangleMesh& mesh = tree.mesh();
  const auto corner = [&](std::uint32_t triangle, std::size_t i) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][i])];
  };
  std::optional<MetTriangle> met;
  double to = ray.to;
  std::array<Waiting, kDeepest> waiting;  // each is written before it is read
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
  // Most triangles are missed: they are told without a division.
  const double sign = determinant < 0.0 ? -1.0 : 1.0, size = sign * determinant, slack = kRounding * size;
  const Vector3d from_a = origin - a;
  const double u = sign * from_a.dot(across);
  if (!(u >= -slack && u <= size + slack)) return std::nullopt;
  const Vector3d up = from_a.cross(ab);
  const double v = sign * direction.dot(up);
  if (!(v >= -slack && u + v <= size + slack)) return std::nullopt;
  const double t = ac.dot(up) / determinant;
  return t >= 0.0 ? std::optional(t) : std::nullopt;
}

}  // namespace elbowroom::core
