// A picture of distances.
#pragma once

#include <cstdint>

#include "recon/images/picture_buffer.h"

namespace elbowroom::recon {

struct DepthMap {
  int width_px = 0;
  int height_px = 0;
  PictureBuffer<float> depth_mm;  // row-major, along the camera's z axis; 0: nothing there
  std::int64_t hit_pixels = 0;    // with something there
};

}  // namespace elbowroom::recon
