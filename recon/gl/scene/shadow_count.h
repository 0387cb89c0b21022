// What a picture's shadows cost.
#pragma once

#include <cstdint>

namespace elbowroom::recon::gl {

// How often shadows were drawn again, and how often those of the last picture still held.
struct ShadowCount {
  std::int64_t part_passes = 0;         // the parts were drawn from the lamp
  std::int64_t kept_part_passes = 0;    // same lamp, same parts at the same poses
  std::int64_t hull_uploads = 0;        // the hull's layer from the lamp went to the graphics card
  std::int64_t kept_hull_uploads = 0;   // same lamp, same layer
  std::int64_t parts_outside_lamp = 0;  // left out of a pass: nowhere in the lamp's cone
};

}  // namespace elbowroom::recon::gl
