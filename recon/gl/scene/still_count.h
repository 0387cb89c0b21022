// How often what stays in a picture was drawn.
#pragma once

#include <cstdint>

namespace elbowroom::recon::gl {

// Whether background, opaque parts, table and lines are kept from picture to picture, which changes a picture
// by rounding only. Pictures of one sample a pixel alone.
enum class StillThings { kKept, kDrawnAnew };

struct StillCount {
  std::int64_t drawn = 0;  // pictures for which it was drawn, to be kept
  std::int64_t kept = 0;   // pictures that took it as it was

  [[nodiscard]] bool operator==(const StillCount&) const = default;
};

}  // namespace elbowroom::recon::gl
