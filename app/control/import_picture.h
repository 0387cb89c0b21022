// A CAD file as it was read: its parts in their colours, and what is wrong with their surfaces.
#pragma once

#include "cad_import/model/cad_model.h"
#include "cad_import/normalisation/surface_defects.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/images/image.h"

namespace elbowroom::control {

// The model seen from above its front right. Drawn over it, also where other surfaces hide them: open edges
// red, edges of three or more triangles violet, edges between triangles that face different ways blue,
// triangles that cross others orange. Below the picture: how many of each there are, and the model's size.
// Throws: core::Error as SceneRenderer::Render.
[[nodiscard]] recon::Image ImportPicture(recon::gl::SceneRenderer& renderer,
                                         const cad_import::CadModel& model,
                                         const cad_import::SurfaceDefects& defects);

}  // namespace elbowroom::control
