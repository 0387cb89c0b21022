#include "app/control/placing/cylinder_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/infinity.h"

namespace elbowroom::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMostOff = 0.02;        // of the radius
constexpr double kLeastSpread = 0.0865;  // of normals that go around by 60 degrees, see below
constexpr double kMostTilt = 1e-3;       // mean square of normals' parts along the axis
constexpr double kMostSagitta = 0.06;    // of the radius: facets of up to 40 degrees
constexpr int kMostSteps = 30;
constexpr double kSettledShare = 1e-14;

struct Circle {
  Vector2d center = Vector2d::Zero();
  double radius = 0.0;
};

std::vector<Vector3d> CornersOf(const core::TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  std::vector<std::int32_t> used;
  for (const std::uint32_t triangle : triangles)
    used.insert(used.end(), mesh.triangles[triangle].begin(), mesh.triangles[triangle].end());
  std::ranges::sort(used);
  used.erase(std::ranges::unique(used).begin(), used.end());
  std::vector<Vector3d> corners;
  for (const std::int32_t i : used) corners.push_back(mesh.vertices_mm[static_cast<std::size_t>(i)]);
  return corners;
}

Vector3d AreaNormal(const core::TriangleMesh& mesh, std::uint32_t triangle) {
  const auto vertex = [&](std::size_t i) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][i])];
  };
  return 0.5 * (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
}

// Kasa's: |x|^2 + a x + b y + c = 0 in the least squares of its left side. Exact where all points are on a
// circle; near it otherwise.
std::optional<Circle> AlgebraicCircle(const std::vector<Vector2d>& points) {
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const Vector2d& x : points) {
    const Vector3d row(x.x(), x.y(), 1.0);
    normal += row * row.transpose();
    right -= x.squaredNorm() * row;
  }
  const Eigen::FullPivLU<Matrix3d> solver(normal);
  if (!solver.isInvertible()) return std::nullopt;  // on one line
  const Vector3d abc = solver.solve(right);
  const Vector2d center = -0.5 * abc.head<2>();
  const double square = center.squaredNorm() - abc.z();
  return square > 0.0 ? std::optional(Circle{center, std::sqrt(square)}) : std::nullopt;
}

// Gauss and Newton's steps for the least squares of | |x - c| - r |.
Circle GeometricCircle(const std::vector<Vector2d>& points, Circle circle) {
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix3d normal = Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const Vector2d& x : points) {
      const Vector2d out = x - circle.center;
      const double distance = out.norm();
      if (distance == 0.0) continue;
      const Vector3d row(-out.x() / distance, -out.y() / distance, -1.0);
      normal += row * row.transpose();
      right -= (distance - circle.radius) * row;
    }
    const Vector3d change = normal.ldlt().solve(right);
    circle.center += change.head<2>();
    circle.radius += change.z();
    if (change.norm() <= kSettledShare * circle.radius) break;
  }
  return circle;
}

// How far the middles of the triangles' sides are inside the cylinder: a prism of few sides isn't one.
double SagittaOf(const core::TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                 const FittedCylinder& cylinder) {
  double most_mm = 0.0;
  for (const std::uint32_t triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto vertex = [&](std::size_t k) -> const Vector3d& {
        return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][k % 3])];
      };
      const Vector3d middle = 0.5 * (vertex(i) + vertex(i + 1)) - cylinder.point;
      const double out_mm = (middle - cylinder.direction.dot(middle) * cylinder.direction).norm();
      most_mm = std::max(most_mm, cylinder.radius_mm - out_mm);
    }
  }
  return most_mm;
}

}  // namespace

std::optional<FittedCylinder> FitCylinder(const core::TriangleMesh& mesh,
                                          std::span<const std::uint32_t> triangles) {
  Matrix3d spread = Matrix3d::Zero();
  double area_mm2 = 0.0;
  for (const std::uint32_t triangle : triangles) {
    const Vector3d area = AreaNormal(mesh, triangle);
    if (area.norm() == 0.0) continue;
    spread += area * area.transpose() / area.norm();
    area_mm2 += area.norm();
  }
  if (!(area_mm2 > 0.0)) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(spread / area_mm2);
  // Of normals that go evenly around by the angle w the middle eigenvalue is (1 - sin w / w) / 2.
  if (!(eigen.eigenvalues()[1] >= kLeastSpread) || !(eigen.eigenvalues()[0] <= kMostTilt))
    return std::nullopt;
  FittedCylinder cylinder;
  cylinder.direction = eigen.eigenvectors().col(0);
  const Vector3d first = cylinder.direction.unitOrthogonal();
  const Vector3d second = cylinder.direction.cross(first);
  const std::vector<Vector3d> corners = CornersOf(mesh, triangles);
  const Vector3d origin = corners.front();
  std::vector<Vector2d> seen;
  double low = core::kInfinity, high = -core::kInfinity;
  for (const Vector3d& corner : corners) {
    const Vector3d x = corner - origin;
    seen.emplace_back(first.dot(x), second.dot(x));
    low = std::min(low, cylinder.direction.dot(x));
    high = std::max(high, cylinder.direction.dot(x));
  }
  const std::optional<Circle> near = AlgebraicCircle(seen);
  if (!near) return std::nullopt;
  const Circle circle = GeometricCircle(seen, *near);
  for (const Vector2d& x : seen)
    cylinder.off_mm = std::max(cylinder.off_mm, std::abs((x - circle.center).norm() - circle.radius));
  if (!(cylinder.off_mm <= kMostOff * circle.radius)) return std::nullopt;
  cylinder.radius_mm = circle.radius;
  cylinder.length_mm = high - low;
  cylinder.point = origin + circle.center.x() * first + circle.center.y() * second +
                   0.5 * (low + high) * cylinder.direction;
  if (SagittaOf(mesh, triangles, cylinder) > kMostSagitta * cylinder.radius_mm) return std::nullopt;
  double outwards = 0.0;
  for (const std::uint32_t triangle : triangles) {
    const Vector3d corner =
        mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle].front())] - cylinder.point;
    const Vector3d out = corner - cylinder.direction.dot(corner) * cylinder.direction;
    outwards += out.dot(AreaNormal(mesh, triangle));
  }
  cylinder.is_hole = outwards < 0.0;
  return cylinder;
}

}  // namespace elbowroom::control
