#include "cad_import/normalisation/surface_topology.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace elbowroom::cad_import {
namespace {

// Disjoint sets whose members know whether they run as their set's root does.
class ParityForest {
 public:
  explicit ParityForest(std::size_t size) : parent_(size), is_odd_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  struct Place {
    std::uint32_t root;
    bool is_odd;
  };
  Place Find(std::uint32_t i) {
    bool is_odd = false;
    std::uint32_t root = i;
    for (; parent_[root] != root; root = parent_[root]) is_odd ^= is_odd_[root] != 0;
    const Place place{root, is_odd};
    while (parent_[i] != root && i != root) {
      const std::uint32_t next = parent_[i];
      const bool was_odd = is_odd_[i] != 0;
      parent_[i] = root;
      is_odd_[i] = is_odd ? 1 : 0;
      is_odd ^= was_odd;
      i = next;
    }
    return place;
  }

  // False: this contradicts what is known.
  bool Unite(std::uint32_t a, std::uint32_t b, bool are_unlike) {
    const Place at = Find(a), to = Find(b);
    const bool is_odd = at.is_odd ^ to.is_odd ^ are_unlike;
    if (at.root == to.root) return !is_odd;
    const auto [low, high] = std::minmax(at.root, to.root);
    parent_[high] = low;
    is_odd_[high] = is_odd ? 1 : 0;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> is_odd_;
};

}  // namespace

std::vector<EdgeUse> SortedEdgeUses(const core::TriangleMesh& mesh) {
  const auto for_each_use = [&](auto visit) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto& corners = mesh.triangles[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t from = corners[k], to = corners[(k + 1) % 3];
        visit(EdgeUse{std::min(from, to), std::max(from, to), i, from < to});
      }
    }
  };
  // A counting sort by the lower vertex. The few edges of each vertex are then sorted by the higher one.
  std::vector<std::size_t> begin(mesh.vertices_mm.size() + 1, 0);
  for_each_use([&](const EdgeUse& use) { ++begin[static_cast<std::size_t>(use.low) + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  std::vector<EdgeUse> uses(3 * mesh.triangles.size());
  for_each_use([&](const EdgeUse& use) { uses[next[static_cast<std::size_t>(use.low)]++] = use; });
  for (std::size_t low = 0; low + 1 < begin.size(); ++low) {
    const auto of_low = std::span(uses).subspan(begin[low], begin[low + 1] - begin[low]);
    std::ranges::sort(of_low, {}, [](const EdgeUse& use) { return std::pair(use.high, use.triangle); });
  }
  return uses;
}

EdgeKind KindOf(std::span<const EdgeUse> edge) {
  if (edge.size() == 1) return EdgeKind::kOpen;
  if (edge.size() > 2) return EdgeKind::kNonManifold;
  return edge[0].is_upward == edge[1].is_upward ? EdgeKind::kInconsistent : EdgeKind::kSound;
}

EdgeCounts CountEdges(std::span<const EdgeUse> sorted) {
  EdgeCounts counts;
  ForEachEdge(sorted, [&](std::span<const EdgeUse> edge) {
    switch (KindOf(edge)) {
      case EdgeKind::kSound:
        break;
      case EdgeKind::kOpen:
        ++counts.open;
        break;
      case EdgeKind::kNonManifold:
        ++counts.non_manifold;
        break;
      case EdgeKind::kInconsistent:
        ++counts.inconsistent;
        break;
    }
  });
  return counts;
}

std::vector<Patch> FindPatches(const core::TriangleMesh& mesh, std::span<const EdgeUse> sorted) {
  ParityForest forest(mesh.triangles.size());
  std::vector<std::uint8_t> is_at_a_rim(mesh.triangles.size(), 0);
  std::vector<std::uint32_t> twisted;
  ForEachEdge(sorted, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2) {
      for (const EdgeUse& use : edge) is_at_a_rim[use.triangle] = 1;
    } else if (!forest.Unite(edge[0].triangle, edge[1].triangle, edge[0].is_upward == edge[1].is_upward)) {
      twisted.push_back(edge[0].triangle);
    }
  });
  constexpr std::uint32_t kNone = 0xffff'ffffU;
  std::vector<std::uint32_t> patch_of_root(mesh.triangles.size(), kNone);
  std::vector<Patch> patches;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [root, is_odd] = forest.Find(i);
    if (patch_of_root[root] == kNone) {
      patch_of_root[root] = static_cast<std::uint32_t>(patches.size());
      patches.emplace_back();
    }
    Patch& patch = patches[patch_of_root[root]];
    patch.triangles.push_back(i);
    if (is_odd) patch.odd.push_back(i);
    if (is_at_a_rim[i] != 0) patch.is_closed = false;
  }
  for (const std::uint32_t triangle : twisted) {
    Patch& patch = patches[patch_of_root[forest.Find(triangle).root]];
    patch.is_orientable = false;
    patch.odd.clear();
  }
  for (Patch& patch : patches) {
    if (2 * patch.odd.size() <= patch.triangles.size()) continue;
    std::vector<std::uint32_t> others;
    std::ranges::set_difference(patch.triangles, patch.odd, std::back_inserter(others));
    patch.odd = std::move(others);
  }
  return patches;
}

std::vector<std::size_t> PieceOfTriangle(const core::TriangleMesh& mesh) {
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
  pieces.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    pieces.push_back(piece_of_root.try_emplace(root_of(triangle[0]), piece_of_root.size()).first->second);
  return pieces;
}

}  // namespace elbowroom::cad_import
