// A part coloured by where it was touched, with a colour bar.
#pragma once

#include "core/heat_map.h"
#include "core/triangle_mesh.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/images/image.h"

namespace elbowroom::control {

// The part twice, side by side: how long each patch was touched, and how deep at most, each in the report's
// depth colours from pale (little) to dark (the map's most; said on its bar), as light as the part is there;
// grey: never touched. Seen from above, or, where it was touched more from below, turned over about its x.
// Throws: core::Error as SceneRenderer::Render.
[[nodiscard]] recon::Image HeatPicture(recon::gl::SceneRenderer& renderer, const core::SharedMesh& mesh,
                                       const core::HeatMap& map);

}  // namespace elbowroom::control
