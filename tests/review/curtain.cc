#include "tests/review/curtain.h"

#include <memory>

namespace elbowroom::review {

core::Part Curtain(int across, int down, double width_mm, double height_mm) {
  auto mesh = std::make_shared<core::TriangleMesh>();
  for (int z = 0; z <= down; ++z)
    for (int x = 0; x <= across; ++x)
      mesh->vertices_mm.emplace_back((static_cast<double>(x) / across - 0.5) * width_mm, 0.0,
                                     -static_cast<double>(z) / down * height_mm);
  const auto at = [&](int x, int z) { return z * (across + 1) + x; };
  for (int z = 0; z < down; ++z) {
    for (int x = 0; x < across; ++x) {
      mesh->triangles.push_back({at(x, z), at(x, z + 1), at(x + 1, z)});
      mesh->triangles.push_back({at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)});
    }
  }
  core::Part part;
  part.name = "curtain";
  part.mesh = std::move(mesh);
  core::ClothRule rule;
  rule.pins = {core::BoundsSide::kZMax};
  part.gives_way = rule;
  return part;
}

}  // namespace elbowroom::review
