// A part coloured by where it was touched, with a colour bar.
#pragma once

#include "core/heat_map.h"
#include "core/triangle_mesh.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/images/image.h"

namespace elbowroom::control {

// The part twice, side by side: coloured by how long each patch was touched, and by how deep it was at most.
// The colours are the report's depth colours, from pale (little) to dark (the map's largest value, written on
// its bar), shaded like the part; grey patches were never touched. The part is seen from above; where it was
// touched more from below, it is turned over about its x axis.
// Throws: core::Error as SceneRenderer::Render.
[[nodiscard]] recon::Image HeatPicture(recon::gl::SceneRenderer& renderer, const core::SharedMesh& mesh,
                                       const core::HeatMap& map);

}  // namespace elbowroom::control
