#include "review/surface_model.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/traversal_recurse.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/error.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

// Sides of two boxes with a smaller sine between them count as parallel. Their cross product isn't tried as
// an axis, only the sides themselves.
constexpr double kParallel = 1e-3;

// Bound of the rounding of a gap between boxes, as a share of the sum of all sizes that enter.
constexpr double kInwards = 1e-14;

std::vector<Vector3d> PointOfEachPiece(const core::TriangleMesh& mesh) {
  std::vector<std::size_t> parent(mesh.vertices_mm.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::int32_t vertex) {
    auto at = static_cast<std::size_t>(vertex);
    while (parent[at] != at) at = parent[at] = parent[parent[at]];
    return at;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root(b)] = root(a);
    parent[root(c)] = root(a);
  }
  std::vector<Vector3d> points;
  std::vector<bool> is_taken(parent.size(), false);
  for (const auto& triangle : mesh.triangles) {
    const std::size_t piece = root(triangle[0]);
    if (!is_taken[piece]) points.push_back(mesh.vertices_mm[piece]);
    is_taken[piece] = true;
  }
  return points;
}

std::vector<Triangle> TrianglesAbout(const core::TriangleMesh& mesh, const Vector3d& middle) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::int32_t i) -> Vector3d {
      return mesh.vertices_mm[static_cast<std::size_t>(i)] - middle;
    };
    triangles.push_back({at(a), at(b), at(c)});
  }
  return triangles;
}

// Builds FCL's model in place: its assignment leaves two models that share one set of arrays.
void Build(const std::vector<Triangle>& triangles, FclMesh& mesh) {
  std::vector<fcl::Vector3d> vertices;
  std::vector<fcl::Triangle> corners;
  vertices.reserve(3 * triangles.size());
  corners.reserve(triangles.size());
  for (const Triangle& triangle : triangles) {
    const std::size_t first = vertices.size();
    vertices.insert(vertices.end(), triangle.begin(), triangle.end());
    corners.emplace_back(first, first + 1, first + 2);
  }
  mesh.beginModel();
  mesh.addSubModel(vertices, corners);
  core::Require(mesh.endModel() == fcl::BVH_OK, "FCL takes any triangles");
}

Triangle Moved(const core::RigidTransform& b_from_a, const Triangle& in_a) {
  return {b_from_a * in_a[0], b_from_a * in_a[1], b_from_a * in_a[2]};
}

// FCL's traversal of two trees, with its lower bounds between their boxes but with GapBetween for two
// triangles: FCL's own distance is too large for some that have nearly parallel edges (docs/clash.md).
class LeastGapWalk final : public fcl::detail::MeshDistanceTraversalNodeOBBRSSd {
 public:
  LeastGapWalk(const std::vector<Triangle>& of_a, const std::vector<Triangle>& of_b,
               const core::RigidTransform& a_from_b)
      : of_a_(of_a), of_b_(of_b), a_from_b_(a_from_b) {
    least_.distance_mm = std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool canStop(double lower_bound_mm) const override {
    return lower_bound_mm >= least_.distance_mm;
  }

  void leafTesting(int node_a, int node_b) const override {
    const auto a = static_cast<std::size_t>(model1->getBV(node_a).primitiveId());
    const auto b = static_cast<std::size_t>(model2->getBV(node_b).primitiveId());
    const SurfaceGap gap = GapBetween(of_a_[a], Moved(a_from_b_, of_b_[b]));
    if (gap.distance_mm < least_.distance_mm) least_ = gap;
  }

  [[nodiscard]] const SurfaceGap& least() const { return least_; }

 private:
  const std::vector<Triangle>& of_a_;
  const std::vector<Triangle>& of_b_;
  const core::RigidTransform& a_from_b_;
  mutable SurfaceGap least_;
};

fcl::Transform3d ToFcl(const core::RigidTransform& b_from_a) {
  fcl::Transform3d result = fcl::Transform3d::Identity();
  result.linear() = b_from_a.rotation;
  result.translation() = b_from_a.translation_mm;
  return result;
}

}  // namespace

// Frame: the mesh's, with its origin at the middle of the mesh's bounds.
struct SurfaceModel::FclModel {
  Vector3d middle_in_part;
  std::vector<Triangle> triangles;
  FclMesh mesh;
};

SurfaceModel::SurfaceModel(core::SharedMesh mesh) : tree_(std::move(mesh)) {
  core::Require(!tree_.mesh().triangles.empty(), "a surface has triangles");
  piece_points_ = PointOfEachPiece(tree_.mesh());
  auto fcl = std::make_unique<FclModel>();
  fcl->middle_in_part = tree_.bounds().center();
  fcl->triangles = TrianglesAbout(tree_.mesh(), fcl->middle_in_part);
  Build(fcl->triangles, fcl->mesh);
  fcl_ = std::move(fcl);
}

SurfaceModel::~SurfaceModel() = default;
SurfaceModel::SurfaceModel(SurfaceModel&&) noexcept = default;
SurfaceModel& SurfaceModel::operator=(SurfaceModel&&) noexcept = default;

SurfacePair::SurfacePair(const SurfaceModel& a, const core::RigidTransform& world_from_a,
                         const SurfaceModel& b, const core::RigidTransform& world_from_b)
    : a_(a), b_(b), world_from_a_(world_from_a) {
  const auto middle_in_world = [](const SurfaceModel& model, const core::RigidTransform& world_from_part) {
    const auto x_in_part = model.fcl_->middle_in_part.cast<long double>();
    return (world_from_part.rotation.cast<long double>() * x_in_part +
            world_from_part.translation_mm.cast<long double>())
        .eval();
  };
  const auto offset = (middle_in_world(b, world_from_b) - middle_in_world(a, world_from_a)).eval();
  a_from_b_.rotation = world_from_a.rotation.transpose() * world_from_b.rotation;
  a_from_b_.translation_mm = world_from_a.rotation.transpose() * offset.cast<double>();
}

double SurfacePair::BoundsGapMm() const {
  const Vector3d half_a = 0.5 * a_.tree().bounds().sizes(), half_b = 0.5 * b_.tree().bounds().sizes();
  const Eigen::Matrix3d& axes_b = a_from_b_.rotation;  // its columns: b's axes in a
  const Vector3d& offset = a_from_b_.translation_mm;
  double gap_mm = 0.0;
  const auto try_axis = [&](const Vector3d& axis) {
    const double length = axis.norm();
    if (length < kParallel) return;
    const double reach_mm = half_a.dot(axis.cwiseAbs()) + half_b.dot((axes_b.transpose() * axis).cwiseAbs());
    gap_mm = std::max(gap_mm, (std::abs(offset.dot(axis)) - reach_mm) / length);
  };
  for (int i = 0; i < 3; ++i) {
    try_axis(Vector3d::Unit(i));
    try_axis(axes_b.col(i));
    for (int j = 0; j < 3; ++j) try_axis(Vector3d::Unit(i).cross(axes_b.col(j)));
  }
  const double size_mm = half_a.sum() + half_b.sum() + offset.cwiseAbs().sum() +
                         a_.fcl_->middle_in_part.cwiseAbs().sum() + b_.fcl_->middle_in_part.cwiseAbs().sum();
  return std::max(0.0, gap_mm - kInwards * size_mm);
}

std::optional<SurfaceGap> SurfacePair::FindIntersection() const {
  const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  fcl::collide(&a_.fcl_->mesh, fcl::Transform3d::Identity(), &b_.fcl_->mesh, ToFcl(a_from_b_), request,
               result);
  if (result.numContacts() == 0) return std::nullopt;
  const fcl::Contactd& contact = result.getContact(0);
  const Triangle& of_a = a_.fcl_->triangles[static_cast<std::size_t>(contact.b1)];
  const Triangle& of_b = b_.fcl_->triangles[static_cast<std::size_t>(contact.b2)];
  return InWorld(GapBetween(of_a, Moved(a_from_b_, of_b)));
}

SurfaceGap SurfacePair::Measure() const {
  LeastGapWalk walk(a_.fcl_->triangles, b_.fcl_->triangles, a_from_b_);
  fcl::DistanceResultd unused;
  fcl::detail::initialize(walk, a_.fcl_->mesh, fcl::Transform3d::Identity(), b_.fcl_->mesh, ToFcl(a_from_b_),
                          fcl::DistanceRequestd(), unused);
  fcl::detail::distanceRecurse<double>(&walk, 0, 0, nullptr);
  return InWorld(walk.least());
}

SurfaceGap SurfacePair::InWorld(const SurfaceGap& gap) const {
  const Vector3d& middle = a_.fcl_->middle_in_part;
  return {gap.distance_mm, world_from_a_ * (gap.on_a + middle), world_from_a_ * (gap.on_b + middle)};
}

}  // namespace elbowroom::review
