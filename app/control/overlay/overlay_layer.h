// All parts as one camera sees them, before anything real hides them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "app/control/overlay/part_faces.h"
#include "app/control/overlay/part_lines.h"

namespace elbowroom::control {

// One part in one camera's picture.
struct PartPicture {
  std::shared_ptr<const OutlinedMesh> mesh;
  core::RigidTransform cam_from_part;
  PartFaces faces;
  PartLines lines;
};

struct OverlayLine {
  LinePiece piece;
  std::uint16_t part = 0;
};

// One item a pixel, row by row.
struct OverlayLayer {
  int width_px = 0;
  int height_px = 0;
  recon::PixelBox box;               // holds all that is drawn
  std::vector<float> face_depth_mm;  // of the nearest part, along the camera's z axis; 0: none
  std::vector<std::uint16_t> face_part;
  std::vector<std::uint8_t> face_shade;
  std::vector<std::uint8_t> line_share;  // how much of the pixel a line covers, 255: all
  std::vector<float> line_depth_mm;
  std::vector<std::uint16_t> line_part;
  std::vector<OverlayLine> lines;  // what is drawn, as curves

  [[nodiscard]] std::size_t At(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x);
  }
};

// Lines that another part hides are left out. A line is `line_width_px` wide; at its rim a pixel gets the
// share by which it lies within. Throws: PreconditionError for more than 65535 parts. Thread: any.
[[nodiscard]] OverlayLayer ComposeLayer(const ViewPixels& view,
                                        std::span<const std::shared_ptr<const PartPicture>> parts,
                                        double line_width_px);

}  // namespace elbowroom::control
