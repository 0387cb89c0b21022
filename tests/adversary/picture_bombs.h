// Small files that claim, or unpack to, more than anybody has.
#pragma once

#include <string>
#include <vector>

namespace elbowroom::adversary {

struct Bomb {
  std::string name;  // with its extension
  std::string bytes;
};

// More than twenty, pictures and videos. Some hold the right size in their headers: `width_px` x `height_px`.
[[nodiscard]] std::vector<Bomb> MakeBombs(int width_px, int height_px);

}  // namespace elbowroom::adversary
