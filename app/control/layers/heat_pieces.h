// The heat layer in a scene: on the parts where they stand, cut open with them.
#pragma once

#include <vector>

#include "app/control/layers/heat_layer.h"
#include "app/control/palette/part_colors.h"
#include "app/control/section/part_sections.h"
#include "app/control/section/section_cut.h"
#include "core/rigid_transform.h"
#include "recon/gl/scene/scene.h"

namespace elbowroom::control {

// Of parts while a layer is shown: no colour of the scale, and no tint of a contact.
inline const Color kPartBesideLayerColor{0.86F, 0.87F, 0.88F};

// Keeps what is cut while nothing changes. Thread: one.
class HeatPieces {
 public:
  // `hangs`: one a part; a part that hangs isn't where its heat map is, and gets none.
  void AddTo(recon::gl::Scene* scene, const HeatLayer& layer,
             const std::vector<core::RigidTransform>& world_from_parts, const std::vector<bool>& hangs,
             const SectionCut& cut);

 private:
  PartSections sections_;
};

}  // namespace elbowroom::control
