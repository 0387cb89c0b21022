// A picture of distances.
#pragma once

#include <cstdint>
#include <vector>

namespace elbowroom::recon {

struct DepthMap {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> depth_mm;  // row-major, along the camera's z axis; 0: nothing there
  std::int64_t hit_pixels = 0;  // with something there
};

}  // namespace elbowroom::recon
