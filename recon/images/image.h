// A finished picture, as the console shows it and a report keeps it.
#pragma once

#include <cstdint>
#include <vector>

namespace elbowroom::recon {

// height_px rows of width_px pixels, top row first, 8-bit red, green, blue, no padding.
struct Image {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;

  [[nodiscard]] bool operator==(const Image&) const = default;
};

}  // namespace elbowroom::recon
