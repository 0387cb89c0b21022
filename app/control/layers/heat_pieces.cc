#include "app/control/layers/heat_pieces.h"

#include <utility>

#include "app/control/palette/scale_color.h"

namespace elbowroom::control {

void HeatPieces::AddTo(recon::gl::Scene* scene, const HeatLayer& layer,
                       const std::vector<core::RigidTransform>& world_from_parts,
                       const std::vector<bool>& hangs, const SectionCut& cut) {
  for (const auto& part : layer.parts) {
    if (part->part >= world_from_parts.size() || hangs[part->part]) continue;
    for (const HeatPiece& piece : part->pieces) {
      recon::gl::ScenePart drawn;
      drawn.mesh = piece.mesh;
      drawn.world_from_part = world_from_parts[part->part];
      drawn.color = ScaleColor((piece.shade - 0.5) / kHeatShades);
      drawn.is_decal = true;
      if (!cut.is_none()) {
        const auto place =
            static_cast<std::size_t>(part->part) * (kHeatShades + 1) + static_cast<std::size_t>(piece.shade);
        drawn.mesh = sections_.SurfaceOf(place, piece.mesh, drawn.world_from_part, cut);
      }
      if (drawn.mesh != nullptr) scene->parts.push_back(std::move(drawn));
    }
  }
}

}  // namespace elbowroom::control
