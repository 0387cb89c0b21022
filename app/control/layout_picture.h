// A layout as it stands: its parts, named, and the gaps between them.
#pragma once

#include <span>

#include "core/layout.h"
#include "core/rigid_transform.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/images/image.h"

namespace elbowroom::control {

// The parts at these poses (one a part), from the front, above; a legend names each in its colour, with its
// size. A gap is a line between the extents that face each other, with its length, drawn over the parts.
// Throws: core::Error as SceneRenderer::Render.
[[nodiscard]] recon::Image LayoutPicture(recon::gl::SceneRenderer& renderer, const core::Layout& layout,
                                         std::span<const core::RigidTransform> world_from_parts);

}  // namespace elbowroom::control
