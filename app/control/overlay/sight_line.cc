#include "app/control/overlay/sight_line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

constexpr double kBeforePoint = 1e-6;
// A tree of 2^31 triangles is about half as deep.
constexpr std::size_t kDeepest = 64;

// The stretch [from, to] of the line eye + s * way.
struct Line {
  Vector3d eye;
  Vector3d way;
  Vector3d per_way;  // 1 / way
  double from;
  double to;
};

// Slab test; a way of 0 along an axis gives infinities, or NaN on a face itself, which max and min leave out.
bool Meets(const Line& line, const Eigen::AlignedBox3d& box) {
  double enters = line.from, leaves = line.to;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double near = (box.min()[axis] - line.eye[axis]) * line.per_way[axis];
    double far = (box.max()[axis] - line.eye[axis]) * line.per_way[axis];
    if (near > far) std::swap(near, far);
    enters = near > enters ? near : enters;
    leaves = far < leaves ? far : leaves;
  }
  return enters <= leaves * (1.0 + 1e-12) + 1e-300;
}

// The line meets the plane at s with s * (way . n) = (a - eye) . n; it is in the triangle if the volumes that
// it spans with the three sides have one sign.
bool Meets(const Line& line, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d to_a = a - line.eye, to_b = b - line.eye, to_c = c - line.eye;
  const double u = line.way.dot(to_b.cross(to_c)), v = line.way.dot(to_c.cross(to_a)),
               w = line.way.dot(to_a.cross(to_b));
  if (!((u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0))) return false;
  const double sum = u + v + w;  // way . n
  if (sum == 0.0) return false;  // seen edge on
  const double s = to_a.dot(to_b.cross(to_c)) / sum;
  return s > line.from && s < line.to;
}

}  // namespace

bool IsHidden(const core::TriangleTree& part, const Vector3d& eye_in_part, const Vector3d& x_in_part,
              double from_share) {
  const Vector3d way = x_in_part - eye_in_part;
  const Line line{eye_in_part, way, way.cwiseInverse(), from_share, 1.0 - kBeforePoint};
  if (part.nodes().empty()) return false;
  const core::TriangleMesh& mesh = part.mesh();
  const auto corner = [&](std::uint32_t triangle, std::size_t i) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][i])];
  };
  std::array<std::uint32_t, kDeepest> waiting{};
  std::size_t count = 1;
  while (count > 0) {
    const core::TriangleTree::Node& node = part.nodes()[waiting[--count]];
    if (!Meets(line, node.box)) continue;
    if (node.left != 0) {
      waiting[count++] = node.left;
      waiting[count++] = node.left + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const std::uint32_t triangle = part.order()[i];
      if (Meets(line, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2))) return true;
    }
  }
  return false;
}

}  // namespace elbowroom::control
