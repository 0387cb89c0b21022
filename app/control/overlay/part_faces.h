// Which pixels of a camera's picture a part covers, and how far away it is there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/control/overlay/view_pixels.h"
#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"

namespace elbowroom::control {

// Of the pixels in `box`, row by row. Empty vectors: the part covers none.
struct PartFaces {
  recon::PixelBox box;
  std::vector<float> depth_mm;      // along the camera's z axis; 0: not covered
  std::vector<std::uint8_t> shade;  // brightness of the face, 255: full

  [[nodiscard]] std::size_t At(int x, int y) const {
    return static_cast<std::size_t>(y - box.y) * static_cast<std::size_t>(box.right - box.x) +
           static_cast<std::size_t>(x - box.x);
  }
};

// The first triangle, of either side, that the ray through each pixel's centre meets beyond kOverlayNearMm.
// Triangles may reach beside and behind the camera. Exact but for float32's rounding of the depth
// (part_faces_test, against all rays and all triangles). Thread: any.
[[nodiscard]] PartFaces DrawFaces(const ViewPixels& view, const core::TriangleMesh& mesh,
                                  const core::RigidTransform& cam_from_part);

}  // namespace elbowroom::control
