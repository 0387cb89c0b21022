#include "cad_import/normalisation/body_joining.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "cad_import/normalisation/surface_topology.h"

namespace elbowroom::cad_import {
namespace {

// Appends b, whose mesh in a's frame is given, as further pieces.
void Join(Body& a, const Body& b, const core::TriangleMesh& b_in_a) {
  const auto owner = static_cast<std::uint32_t>(a.piece_names.size());
  core::Append(a.owned.mesh, b_in_a);
  for (const std::uint32_t of_b : b.owned.owner_of_triangle)
    a.owned.owner_of_triangle.push_back(owner + of_b);
  a.piece_names.insert(a.piece_names.end(), b.piece_names.begin(), b.piece_names.end());
  a.deviation = std::max(a.deviation, b.deviation);
}

// For each body the first one that it is connected with by shared vertices, directly or through others.
std::vector<std::size_t> GroupsOf(const std::vector<core::TriangleMesh>& meshes) {
  std::vector<std::size_t> group(meshes.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto root_of = [&](std::size_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  std::map<std::array<double, 3>, std::size_t> user;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    for (const Eigen::Vector3d& vertex : meshes[i].vertices_mm) {
      const auto [found, is_new] = user.try_emplace({vertex.x(), vertex.y(), vertex.z()}, i);
      if (is_new) continue;
      const std::size_t a = root_of(found->second), b = root_of(i);
      group[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = root_of(i);
  return group;
}

// Each edge is of two triangles; which way they face is healed later.
bool HasNoOpenEdge(const core::TriangleMesh& mesh) {
  const EdgeCounts edges = CountEdges(SortedEdgeUses(mesh));
  return !mesh.triangles.empty() && edges.open == 0 && edges.non_manifold == 0;
}

// Those whose bodies are open and stand nowhere else.
std::vector<std::size_t> OpenInstances(const BodyScene& scene) {
  std::vector<std::size_t> open;
  if (scene.instances.size() < 2) return open;
  std::vector<int> uses(scene.bodies.size(), 0);
  for (const CadInstance& instance : scene.instances) ++uses[instance.shape];
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const std::size_t shape = scene.instances[i].shape;
    if (uses[shape] == 1 && !core::IsWatertight(scene.bodies[shape].owned.mesh)) open.push_back(i);
  }
  return open;
}

// The scene without the instances that go, and without bodies that no instance needs any more.
BodyScene Without(BodyScene scene, const std::vector<std::uint8_t>& goes) {
  BodyScene result;
  std::map<std::size_t, std::size_t> new_shape;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (goes[i] != 0) continue;
    CadInstance instance = std::move(scene.instances[i]);
    const auto [found, is_new] = new_shape.try_emplace(instance.shape, result.bodies.size());
    if (is_new) {
      result.bodies.push_back(std::move(scene.bodies[instance.shape]));
    }
    instance.shape = found->second;
    result.instances.push_back(std::move(instance));
  }
  return result;
}

}  // namespace

Body BodyOf(RawShape shape) {
  Body body{{std::move(shape.mesh), {}}, {shape.name}, shape.deviation, shape.name};
  body.owned.owner_of_triangle.assign(body.owned.mesh.triangles.size(), 0);
  Weld(body.owned);
  return body;
}

int JoinOpenBodies(BodyScene& scene) {
  const std::vector<std::size_t> open = OpenInstances(scene);
  if (open.size() < 2) return 0;
  std::vector<core::TriangleMesh> in_model;
  for (const std::size_t i : open) {
    const CadInstance& instance = scene.instances[i];
    in_model.push_back(core::Transformed(scene.bodies[instance.shape].owned.mesh, instance.model_from_shape));
  }
  std::map<std::size_t, std::vector<std::size_t>> groups;
  const std::vector<std::size_t> group_of = GroupsOf(in_model);
  for (std::size_t i = 0; i < open.size(); ++i) groups[group_of[i]].push_back(i);
  std::vector<std::uint8_t> is_joined(scene.instances.size(), 0);
  int joined = 0;
  for (const auto& [first, members] : groups) {
    if (members.size() < 2) continue;
    Body all;
    for (const std::size_t i : members) Join(all, scene.bodies[scene.instances[open[i]].shape], in_model[i]);
    Weld(all.owned);
    if (!HasNoOpenEdge(all.owned.mesh)) continue;
    CadInstance& instance = scene.instances[open[first]];
    all.name = scene.bodies[instance.shape].name;
    scene.bodies[instance.shape] = std::move(all);
    instance.model_from_shape = {};
    for (const std::size_t i : members) is_joined[open[i]] = i == first ? 0 : 1;
    joined += static_cast<int>(members.size());
  }
  if (joined > 0) scene = Without(std::move(scene), is_joined);
  return joined;
}

void SplitIntoPieces(Body& body) {
  core::TriangleMesh& mesh = body.owned.mesh;
  const std::vector<std::size_t> pieces = PieceOfTriangle(mesh);
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return pieces[i]; });
  const auto triangles = mesh.triangles;
  for (std::size_t i = 0; i < order.size(); ++i) {
    mesh.triangles[i] = triangles[order[i]];
    body.owned.owner_of_triangle[i] = static_cast<std::uint32_t>(pieces[order[i]]);
  }
  if (!order.empty()) body.piece_names.assign(pieces[order.back()] + 1, body.piece_names.front());
}

}  // namespace elbowroom::cad_import
