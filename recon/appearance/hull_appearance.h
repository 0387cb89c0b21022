// How the hull's surface is coloured, and its colours from pictures of the real objects.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "recon/appearance/camera_texture.h"
#include "recon/appearance/scene_view.h"
#include "recon/exact_view/hull_view.h"

namespace elbowroom::recon {

enum class HullAppearance {
  kFlat,        // one colour, the paper's glove
  kByNormal,    // one colour, shaded by the surface's direction
  kOneCamera,   // from the picture of one camera, worn on the head or near the viewer (the paper's way)
  kRigCameras,  // from the pictures of all the rig's cameras that see the point
  kCoverage,    // by how many cameras see the point
  kUncertainty  // by how far the surface may be off there
};

// Whether each pixel has a colour of its own.
[[nodiscard]] bool HasPixelColors(HullAppearance appearance);

// Red, green, blue, and how far they are to be trusted: 0 where no camera sees the point, 255 where one sees
// it well, smooth between.
using CameraColor = std::array<std::uint8_t, 4>;

// A colour for each pixel of `picture`, which is the hull as `view` sees it; row-major. The photos that see a
// point are blended by how well they see it and by the angle between their line of sight and the viewer's;
// the blend is continuous along the surface as long as depth and normal are (docs/appearance.md). There is no
// colour where no normal is known. Parallel over rows; the result doesn't depend on the number of threads.
// Throws: PreconditionError when the picture's size isn't the view's.
[[nodiscard]] std::vector<CameraColor> ColorHull(
    const HullView& picture, const SceneView& view,
    std::span<const std::shared_ptr<const CameraTexture>> photos);

}  // namespace elbowroom::recon
