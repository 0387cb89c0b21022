#include "core/bvh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/infinity.h"

namespace elbowroom::core {
namespace {

constexpr std::uint32_t kTrianglesInLeaf = 4;
// Balls grow by this share, so that rounding never leaves a vertex outside.
constexpr double kOutwards = 1e-12;

Eigen::Vector3d Centroid(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.vertices_mm[static_cast<std::size_t>(a)] + mesh.vertices_mm[static_cast<std::size_t>(b)] +
          mesh.vertices_mm[static_cast<std::size_t>(c)]) /
         3.0;
}

// The smallest ball around the centre of the bounding box. Its radius is at most sqrt(3) times that of the
// smallest ball of all; usually it is a few percent larger.
Ball BallAround(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t triangle : triangles) {
    for (const std::int32_t vertex : mesh.triangles[triangle])
      box.extend(mesh.vertices_mm[static_cast<std::size_t>(vertex)]);
  }
  Ball ball{box.center(), 0.0};
  for (const std::uint32_t triangle : triangles) {
    for (const std::int32_t vertex : mesh.triangles[triangle]) {
      ball.radius_mm =
          std::max(ball.radius_mm, (mesh.vertices_mm[static_cast<std::size_t>(vertex)] - ball.center).norm());
    }
  }
  ball.radius_mm *= 1.0 + kOutwards;
  return ball;
}

Eigen::AlignedBox3d BoxAround(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t triangle : triangles)
    for (const std::int32_t vertex : mesh.triangles[triangle])
      box.extend(mesh.vertices_mm[static_cast<std::size_t>(vertex)]);
  return box;
}

// Across the sum of the triangles' area vectors, each turned to the side of the first, so that the two faces
// of a plate don't cancel.
Disc DiscAround(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  const auto vertex = [&](std::int32_t i) -> const Eigen::Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(i)];
  };
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t triangle : triangles) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Eigen::Vector3d area = (vertex(b) - vertex(a)).cross(vertex(c) - vertex(a));
    if (sum.dot(area) < 0.0)
      sum -= area;
    else
      sum += area;
  }
  Disc disc;
  const double length = sum.norm();
  if (length > 0.0 && std::isfinite(length)) disc.normal = sum / length;
  Eigen::AlignedBox3d box;
  double low = kInfinity, high = -kInfinity;
  for (const std::uint32_t triangle : triangles) {
    for (const std::int32_t i : mesh.triangles[triangle]) {
      box.extend(vertex(i));
      const double height = disc.normal.dot(vertex(i));
      low = std::min(low, height);
      high = std::max(high, height);
    }
  }
  const Eigen::Vector3d middle = box.center();
  disc.center = middle + (0.5 * (low + high) - disc.normal.dot(middle)) * disc.normal;
  double radius_mm = 0.0;
  for (const std::uint32_t triangle : triangles) {
    for (const std::int32_t i : mesh.triangles[triangle]) {
      const Eigen::Vector3d from_center = vertex(i) - disc.center;
      const double height = disc.normal.dot(from_center);
      disc.half_height_mm = std::max(disc.half_height_mm, std::abs(height));
      radius_mm = std::max(radius_mm, (from_center - height * disc.normal).norm());
    }
  }
  const double scale_mm = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
  disc.half_height_mm += kOutwards * scale_mm;
  disc.radius_mm = radius_mm + kOutwards * scale_mm;
  return disc;
}

double AreaOf(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  double area_mm2 = 0.0;
  for (const std::uint32_t triangle : triangles) {
    const auto vertex = [&](std::size_t i) -> const Eigen::Vector3d& {
      return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][i])];
    };
    area_mm2 += 0.5 * (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).norm();
  }
  return area_mm2;
}

}  // namespace

Ball BallOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  // If an angle is obtuse or right, the longest side is the smallest ball's diameter. Otherwise its centre is
  // that of the circumscribed circle, by barycentric coordinates.
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  Ball ball;
  if (ab >= bc + ca) {
    ball.center = 0.5 * (a + b);
  } else if (bc >= ab + ca) {
    ball.center = 0.5 * (b + c);
  } else if (ca >= ab + bc) {
    ball.center = 0.5 * (c + a);
  } else {
    const double wa = bc * (ab + ca - bc), wb = ca * (ab + bc - ca), wc = ab * (bc + ca - ab);
    ball.center = (wa * a + wb * b + wc * c) / (wa + wb + wc);
  }
  const double square = std::max(
      {(a - ball.center).squaredNorm(), (b - ball.center).squaredNorm(), (c - ball.center).squaredNorm()});
  ball.radius_mm = std::sqrt(square) * (1.0 + kOutwards);
  return ball;
}

TriangleTree::TriangleTree(SharedMesh mesh) : mesh_(std::move(mesh)) {
  Require(mesh_ != nullptr, "a tree has a mesh");
  is_closed_ = IsWatertight(*mesh_);
  bounds_ = BoundsOf(*mesh_);
  order_.resize(mesh_->triangles.size());
  std::iota(order_.begin(), order_.end(), 0U);
  if (order_.empty()) return;
  nodes_.push_back({{}, {}, {}, 0.0, 0, static_cast<std::uint32_t>(order_.size()), 0});
  Build(0);
}

void TriangleTree::Build(std::uint32_t node) {
  const std::uint32_t begin = nodes_[node].begin, end = nodes_[node].end;
  const std::span<std::uint32_t> triangles(order_.data() + begin, end - begin);
  nodes_[node].ball = BallAround(*mesh_, triangles);
  nodes_[node].box = BoxAround(*mesh_, triangles);
  nodes_[node].disc = DiscAround(*mesh_, triangles);
  nodes_[node].area_mm2 = AreaOf(*mesh_, triangles);
  if (end - begin <= kTrianglesInLeaf) return;
  Eigen::AlignedBox3d box;
  for (const std::uint32_t triangle : triangles) box.extend(Centroid(*mesh_, triangle));
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::uint32_t half = (end - begin) / 2;
  std::nth_element(
      triangles.begin(), triangles.begin() + half, triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double at_a = Centroid(*mesh_, a)[axis], at_b = Centroid(*mesh_, b)[axis];
        return at_a != at_b ? at_a < at_b : a < b;  // a strict order: the tree is the same on every machine
      });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].left = left;
  nodes_.push_back({{}, {}, {}, 0.0, begin, begin + half, 0});
  nodes_.push_back({{}, {}, {}, 0.0, begin + half, end, 0});
  Build(left);
  Build(left + 1);
}

Eigen::AlignedBox3d BoxAround(const TriangleTree& tree, const RigidTransform& b_from_mesh) {
  if (tree.bounds().isEmpty()) return {};
  const Eigen::Vector3d center = b_from_mesh * tree.bounds().center();
  const Eigen::Vector3d half = 0.5 * (b_from_mesh.rotation.cwiseAbs() * tree.bounds().sizes());
  return {center - half, center + half};
}

}  // namespace elbowroom::core
