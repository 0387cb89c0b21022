// Where parts were touched, as coloured pieces of their surfaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/heat_map.h"
#include "core/ids.h"
#include "core/surface_patches.h"
#include "core/triangle_mesh.h"

namespace elbowroom::control {

inline constexpr int kHeatShades = 12;

// The patches of a part whose time of touch is within one shade.
struct HeatPiece {
  core::SharedMesh mesh;  // in the part's frame; not closed
  int shade = 1;          // 1 to kHeatShades: above (shade - 1) / kHeatShades of the scale, up to
                          // shade / kHeatShades
};

struct PartHeat {
  core::PartIndex part = 0;
  std::vector<HeatPiece> pieces;
};

// Immutable; what didn't change is shared with the layer before.
struct HeatLayer {
  std::vector<std::shared_ptr<const PartHeat>> parts;  // those that were touched, in the layout's order
  double most_s = 0.0;  // the scale's end, a round number; 0: nothing was touched
};

using SharedHeatLayer = std::shared_ptr<const HeatLayer>;

// Layers of one layout from its heat maps. Pieces whose patches are the same as in the layer before are the
// same objects, so that nothing of them is drawn anew. Thread: one.
class HeatLayerMaker {
 public:
  // One mesh a part, those that the maps are of.
  explicit HeatLayerMaker(std::vector<core::SharedMesh> part_meshes);

  // Takes the place of the part's map before. Throws: PreconditionError for a map of another mesh.
  void Take(core::HeatMap map);
  [[nodiscard]] SharedHeatLayer Make();

  [[nodiscard]] std::int64_t pieces_made() const { return pieces_made_; }  // since the start

 private:
  struct Part {
    core::SharedMesh mesh;
    std::optional<core::SurfacePatches> patches;  // once it was touched
    std::vector<float> dwell_s;
    float most_s = 0.0F;
    double scale_s = 0.0;                      // that `layer` was made with; 0: it is out of date
    std::vector<std::vector<std::size_t>> of;  // the patches of each shade, in `layer`
    std::shared_ptr<const PartHeat> layer;
  };
  void Renew(core::PartIndex index, double most_s);
  [[nodiscard]] static core::SharedMesh MeshOf(const Part& part, const std::vector<std::size_t>& patches);

  std::vector<Part> parts_;
  std::int64_t pieces_made_ = 0;
};

}  // namespace elbowroom::control
