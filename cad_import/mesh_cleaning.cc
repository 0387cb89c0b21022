#include "cad_import/mesh_cleaning.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::TriangleMesh;
using Triangle = std::array<std::int32_t, 3>;

// A triangle is flat when its height is below this share of its longest edge: rounding, not shape.
constexpr double kFlatRatio = 1e-9;

const Eigen::Vector3d& At(const TriangleMesh& mesh, std::int32_t index) {
  return mesh.vertices_mm[static_cast<std::size_t>(index)];
}

bool HasEqualCorners(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool IsFlat(const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d ab = At(mesh, t[1]) - At(mesh, t[0]);
  const Eigen::Vector3d ac = At(mesh, t[2]) - At(mesh, t[0]);
  const double longest_squared = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  return ab.cross(ac).norm() <= kFlatRatio * longest_squared;
}

// Sets coordinates that are rounding noise beside the size of the whole to zero. Modellers write 3e-17 for 0
// in one triangle and 0 in the next; in single precision such twins only exist around zero.
void ClearNoise(std::vector<RawPart>& parts) {
  constexpr double kNoiseRatio = 1e-9;
  Eigen::AlignedBox3d bounds;
  for (const RawPart& part : parts) bounds.extend(core::BoundsOf(part.mesh));
  const double noise_mm = bounds.isEmpty() ? 0.0 : kNoiseRatio * bounds.diagonal().norm();
  for (RawPart& part : parts) {
    for (Eigen::Vector3d& vertex : part.mesh.vertices_mm) {
      vertex = (vertex.array().abs() <= noise_mm).select(0.0, vertex);
    }
  }
}

// For each vertex the one of its bit-equal twins that stands for all.
std::vector<std::int32_t> Representatives(const TriangleMesh& mesh) {
  std::vector<std::int32_t> order(mesh.vertices_mm.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    const Eigen::Vector3d &a = At(mesh, i), &b = At(mesh, j);
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  std::vector<std::int32_t> representative(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_twin = i > 0 && At(mesh, order[i]) == At(mesh, order[i - 1]);
    representative[static_cast<std::size_t>(order[i])] =
        is_twin ? representative[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return representative;
}

// Bit-equal vertices become one, in the order of their first use; unused ones go. Triangles keep their
// places.
TriangleMesh Weld(const TriangleMesh& mesh) {
  const std::vector<std::int32_t> representative = Representatives(mesh);
  TriangleMesh welded;
  std::vector<std::int32_t> new_index(mesh.vertices_mm.size(), -1);
  welded.triangles.reserve(mesh.triangles.size());
  for (Triangle triangle : mesh.triangles) {
    for (std::int32_t& corner : triangle) {
      const std::int32_t old_index = representative[static_cast<std::size_t>(corner)];
      std::int32_t& index = new_index[static_cast<std::size_t>(old_index)];
      if (index < 0) {
        index = static_cast<std::int32_t>(welded.vertices_mm.size());
        welded.vertices_mm.push_back(At(mesh, old_index));
      }
      corner = index;
    }
    welded.triangles.push_back(triangle);
  }
  return welded;
}

// Edges without exactly one neighbour that runs the other way.
std::int64_t CountLooseEdges(const TriangleMesh& mesh) {
  using Edge = std::pair<std::int32_t, std::int32_t>;
  std::vector<Edge> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  return std::count_if(edges.begin(), edges.end(), [&](const Edge& edge) {
    const auto same = std::equal_range(edges.begin(), edges.end(), edge);
    const auto opposite = std::equal_range(edges.begin(), edges.end(), Edge{edge.second, edge.first});
    return same.second - same.first != 1 || opposite.second - opposite.first != 1;
  });
}

// Parts that share vertices: one closed part, or all open ones together.
struct Body {
  TriangleMesh mesh;
  std::vector<std::size_t> part_of_triangle;  // ascending
};

// Those triangles of `body` for which `goes` is false.
template <typename Predicate>
Body Without(const Body& body, Predicate goes) {
  Body kept{{body.mesh.vertices_mm, {}}, {}};
  for (std::size_t i = 0; i < body.mesh.triangles.size(); ++i) {
    if (goes(body.mesh.triangles[i])) continue;
    kept.mesh.triangles.push_back(body.mesh.triangles[i]);
    kept.part_of_triangle.push_back(body.part_of_triangle[i]);
  }
  return kept;
}

std::vector<Body> SplitIntoBodies(const std::vector<RawPart>& parts) {
  std::vector<Body> bodies;
  Body open;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Body whole{Weld(parts[i].mesh), std::vector<std::size_t>(parts[i].mesh.triangles.size(), i)};
    Body part = Without(whole, HasEqualCorners);
    if (core::IsWatertight(part.mesh)) {
      bodies.push_back(std::move(part));
    } else {
      core::Append(open.mesh, part.mesh);
      open.part_of_triangle.insert(open.part_of_triangle.end(), part.part_of_triangle.begin(),
                                   part.part_of_triangle.end());
    }
  }
  open.mesh = Weld(open.mesh);
  if (!open.mesh.triangles.empty()) bodies.push_back(std::move(open));
  return bodies;
}

// Drops or keeps the flat triangles of a body, turns it outwards; tells `result` what it did.
void Settle(Body& body, CleanMesh& result) {
  const auto is_flat = [&](const Triangle& t) { return IsFlat(body.mesh, t); };
  const bool is_closed = core::IsWatertight(body.mesh);
  const auto flat = std::count_if(body.mesh.triangles.begin(), body.mesh.triangles.end(), is_flat);
  if (flat > 0 && is_closed) {
    result.warnings.push_back(
        fmt::format("{} triangles have no area but hold a closed surface together; they were kept", flat));
  } else if (flat > 0) {
    body = Without(body, is_flat);
    body.mesh = Weld(body.mesh);
  }
  if (is_closed && core::VolumeMm3(body.mesh) < 0.0) {
    for (Triangle& t : body.mesh.triangles) std::swap(t[1], t[2]);
    result.repaired = true;
    result.warnings.emplace_back("a closed surface faced inwards; it was turned inside out");
  }
  result.watertight = result.watertight && core::IsWatertight(body.mesh);
}

// For each triangle the number of the connected piece it belongs to, counted in order of appearance.
std::vector<std::size_t> PieceOfTriangle(const TriangleMesh& mesh) {
  std::vector<std::size_t> parent(mesh.vertices_mm.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root_of = [&](std::int32_t vertex) {
    auto i = static_cast<std::size_t>(vertex);
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root_of(b)] = root_of(a);
    parent[root_of(c)] = root_of(a);
  }
  std::map<std::size_t, std::size_t> piece_of_root;
  std::vector<std::size_t> pieces;
  for (const Triangle& t : mesh.triangles) {
    pieces.push_back(piece_of_root.try_emplace(root_of(t[0]), piece_of_root.size()).first->second);
  }
  return pieces;
}

// Sorts the triangles by connected piece, and numbers each piece as a part of its own.
void SplitIntoPieces(Body& body) {
  const std::vector<std::size_t> pieces = PieceOfTriangle(body.mesh);
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return pieces[a] < pieces[b]; });
  Body sorted{{body.mesh.vertices_mm, {}}, {}};
  for (const std::size_t i : order) {
    sorted.mesh.triangles.push_back(body.mesh.triangles[i]);
    sorted.part_of_triangle.push_back(pieces[i]);
  }
  body = std::move(sorted);
}

// A file of one part has no other name for its pieces.
void Flatten(const Body& body, const std::vector<RawPart>& parts, CleanMesh& result) {
  const auto first = static_cast<std::int64_t>(result.mesh.triangles.size());
  core::Append(result.mesh, body.mesh);
  const std::vector<std::size_t>& owners = body.part_of_triangle;
  for (auto begin = owners.begin(); begin != owners.end();) {
    const auto end = std::upper_bound(begin, owners.end(), *begin);
    const std::string& name = parts[parts.size() == 1 ? 0 : *begin].name;
    result.parts.push_back({name, first + (begin - owners.begin()), end - begin});
    begin = end;
  }
}

}  // namespace

CleanMesh CleanParts(std::vector<RawPart> parts, const std::string& where) {
  std::int64_t before = 0;
  for (const RawPart& part : parts) {
    if (part.mesh.triangles.empty()) continue;
    core::ValidateMesh(part.mesh, where);  // before anything is sorted: NaN has no order
    before += static_cast<std::int64_t>(part.mesh.triangles.size());
  }
  ClearNoise(parts);
  CleanMesh result;
  result.watertight = true;
  for (Body& body : SplitIntoBodies(parts)) {
    Settle(body, result);
    if (parts.size() == 1) SplitIntoPieces(body);
    Flatten(body, parts, result);
  }
  core::ValidateMesh(result.mesh, where);
  result.dropped_triangles = before - static_cast<std::int64_t>(result.mesh.triangles.size());
  if (result.dropped_triangles > 0) {
    result.repaired = true;
    result.warnings.push_back(
        fmt::format("{} triangles without area were dropped", result.dropped_triangles));
  }
  if (!result.watertight) {
    result.warnings.push_back(fmt::format(
        "the surface is open or not consistently oriented: {} edges have no partner; volumes inside it "
        "mean nothing",
        CountLooseEdges(result.mesh)));
  }
  return result;
}

}  // namespace elbowroom::cad_import
