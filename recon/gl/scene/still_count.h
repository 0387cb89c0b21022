// How often what stays in a picture was drawn.
#pragma once

#include <cstdint>

namespace elbowroom::recon::gl {

// Whether background, opaque parts, table and lines are kept from picture to picture, which changes a picture
// by rounding only. Pictures of one sample a pixel alone.
enum class StillThings { kKept, kDrawnAnew };

struct StillCount {
  std::int64_t drawn = 0;    // pictures for which all of it was drawn, to be kept
  std::int64_t renewed = 0;  // pictures for which only the squares were drawn that had changed
  std::int64_t kept = 0;     // pictures that took it as it was

  [[nodiscard]] bool operator==(const StillCount&) const = default;
};

// Squares of 16 pixels, of the pictures for which what stays was renewed.
struct SquareCount {
  std::int64_t drawn = 0;
  std::int64_t left = 0;  // as they were
};

}  // namespace elbowroom::recon::gl
