#include "tests/recon/scenes/vertex_fans.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace elbowroom::recon {

bool EveryVertexHasOneFan(const core::TriangleMesh& mesh) {
  std::vector<std::vector<std::pair<int, int>>> opposite(mesh.vertices_mm.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    opposite[static_cast<std::size_t>(a)].emplace_back(b, c);
    opposite[static_cast<std::size_t>(b)].emplace_back(c, a);
    opposite[static_cast<std::size_t>(c)].emplace_back(a, b);
  }
  return std::ranges::all_of(opposite, [](const auto& edges) {
    if (edges.empty()) return false;
    std::size_t steps = 0;
    int at = edges.front().first;
    do {
      const auto next = std::ranges::find(edges, at, &std::pair<int, int>::first);
      if (next == edges.end()) return false;
      at = next->second;
      ++steps;
    } while (at != edges.front().first && steps <= edges.size());
    return steps == edges.size();
  });
}

}  // namespace elbowroom::recon
