// A tree of balls and boxes over a mesh's triangles.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"

namespace elbowroom::core {

struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
};

// A flat cylinder: the points within `half_height_mm` of the plane through `center` across `normal` (unit),
// and within `radius_mm` of the line through it along `normal`.
struct Disc {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double half_height_mm = 0.0;
  double radius_mm = 0.0;
};

// The smallest ball that encloses the triangle, made larger by what rounding may leave out.
[[nodiscard]] Ball BallOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

// Node 0 is the root; children are `left` and `left + 1`, leaves have left == 0. Each node covers the
// triangles order()[begin .. end). Its box is the smallest around them; its ball encloses them, but isn't the
// smallest. Its disc encloses them and lies along them: where a surface is smooth, a disc is thinner than a
// box by the square of its size. All are in the mesh's frame. Immutable. Thread: any.
class TriangleTree {
 public:
  struct Node {
    Ball ball;
    Eigen::AlignedBox3d box;
    Disc disc;
    double area_mm2 = 0.0;  // sum over its triangles
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t left = 0;
  };

  // Nodes are split at the median along the longest side of the box of their triangles' centroids. A leaf has
  // at most 4 triangles. An empty mesh has no node.
  explicit TriangleTree(SharedMesh mesh);

  [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const SharedMesh& shared_mesh() const { return mesh_; }
  [[nodiscard]] bool is_closed() const { return is_closed_; }  // IsWatertight of the mesh
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }

 private:
  void Build(std::uint32_t node);

  SharedMesh mesh_;
  bool is_closed_ = false;
  Eigen::AlignedBox3d bounds_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

// A box of frame b that encloses the tree's bounds.
[[nodiscard]] Eigen::AlignedBox3d BoxAround(const TriangleTree& tree, const RigidTransform& b_from_mesh);

}  // namespace elbowroom::core
