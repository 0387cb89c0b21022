#include "tests/support/panel_mesh.h"

namespace elbowroom::test_support {

core::TriangleMesh PanelMesh(int across, int down, const Eigen::Vector3d& corner_mm,
                             const Eigen::Vector3d& across_mm, const Eigen::Vector3d& down_mm) {
  core::TriangleMesh mesh;
  for (int j = 0; j <= down; ++j)
    for (int i = 0; i <= across; ++i)
      mesh.vertices_mm.emplace_back(corner_mm + static_cast<double>(i) / across * across_mm +
                                    static_cast<double>(j) / down * down_mm);
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      const int a = j * (across + 1) + i, b = a + 1, c = a + across + 1, d = c + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({b, d, c});
    }
  }
  return mesh;
}

}  // namespace elbowroom::test_support
