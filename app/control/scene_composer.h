// A frame's result as a scene to draw.
#pragma once

#include "app/control/frame_result.h"
#include "recon/gl/scene.h"
#include "recon/orbit_camera.h"

namespace elbowroom::control {

// Parts at their poses (those in contact tinted), the hull as it is seen from `view` exactly, contact points,
// the table. A part between the operator and the hull can be seen through.
// hull_scale: of the picture's side, (0, 1]; a hull of fewer pixels is drawn sooner and scaled up.
[[nodiscard]] recon::gl::Scene ComposeScene(const FrameResult& result, const recon::SceneView& view,
                                            double hull_scale = 1.0);

// A first view of a layout and the hull's whereabouts: everything in the picture, from the front, above.
[[nodiscard]] recon::OrbitCamera OverviewCamera(const FrameResult& result, int width_px, int height_px);

// Closer to one part's contact.
[[nodiscard]] recon::OrbitCamera ContactCamera(const FrameResult& result, core::PartIndex part, int width_px,
                                               int height_px);

}  // namespace elbowroom::control
