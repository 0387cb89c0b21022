#include "tests/review/curtain.h"

#include <memory>

#include "tests/support/panel_mesh.h"

namespace elbowroom::review {

core::Part Curtain(int across, int down, double width_mm, double height_mm) {
  core::Part part;
  part.name = "curtain";
  part.mesh = std::make_shared<const core::TriangleMesh>(test_support::PanelMesh(
      across, down, {0.5 * width_mm, 0.0, 0.0}, {-width_mm, 0.0, 0.0}, {0.0, 0.0, -height_mm}));
  core::ClothRule rule;
  rule.pins = {core::BoundsSide::kZMax};
  part.gives_way = rule;
  return part;
}

}  // namespace elbowroom::review
