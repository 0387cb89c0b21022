#include "tests/oracles/mesh_sides.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <vector>

#include "core/error.h"

namespace elbowroom::oracles {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;

Mesh MeshOf(const core::TriangleMesh& source) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Eigen::Vector3d& v : source.vertices_mm)
    vertices.push_back(mesh.add_vertex({v.x(), v.y(), v.z()}));
  for (const auto& [a, b, c] : source.triangles) {
    const auto at = [&](std::int32_t i) { return vertices[static_cast<std::size_t>(i)]; };
    core::Require(mesh.add_face(at(a), at(b), at(c)) != Mesh::null_face(), "a 2-manifold");
  }
  core::Require(CGAL::is_closed(mesh), "a closed mesh");
  return mesh;
}

}  // namespace

struct MeshSides::Impl {
  explicit Impl(const core::TriangleMesh& source)
      : mesh(MeshOf(source)), tree(faces(mesh).begin(), faces(mesh).end(), mesh), side(tree) {
    tree.accelerate_distance_queries();
  }
  Mesh mesh;
  Tree tree;
  CGAL::Side_of_triangle_mesh<Mesh, Kernel> side;
};

MeshSides::MeshSides(const core::TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
MeshSides::~MeshSides() = default;

bool MeshSides::Holds(const Eigen::Vector3d& point) const {
  return impl_->side({point.x(), point.y(), point.z()}) != CGAL::ON_UNBOUNDED_SIDE;
}

double MeshSides::DistanceMm(const Eigen::Vector3d& point) const {
  return std::sqrt(impl_->tree.squared_distance({point.x(), point.y(), point.z()}));
}

}  // namespace elbowroom::oracles
