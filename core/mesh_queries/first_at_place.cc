#include "core/mesh_queries/first_at_place.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace elbowroom::core {

std::vector<std::int32_t> FirstAtPlace(const TriangleMesh& mesh) {
  const std::vector<Eigen::Vector3d>& vertices = mesh.vertices_mm;
  std::vector<std::int32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](std::int32_t i) -> const Eigen::Vector3d& {
    return vertices[static_cast<std::size_t>(i)];
  };
  std::ranges::sort(order, [&](std::int32_t i, std::int32_t j) {
    const std::array<double, 3> a{at(i).x(), at(i).y(), at(i).z()}, b{at(j).x(), at(j).y(), at(j).z()};
    return a != b ? a < b : i < j;
  });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool is_new = k == 0 || at(order[k]) != at(order[k - 1]);
    first[static_cast<std::size_t>(order[k])] =
        is_new ? order[k] : first[static_cast<std::size_t>(order[k - 1])];
  }
  return first;
}

}  // namespace elbowroom::core
