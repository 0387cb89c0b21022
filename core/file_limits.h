// How far numbers may go in files that people write: what is beyond is a slip or damage.
#pragma once

#include <cstddef>

namespace elbowroom::core {

// A thousand kilometres: nothing on a table is longer.
inline constexpr double kLongestLengthMm = 1e9;

// A camera's number in a hull is a byte.
inline constexpr std::size_t kMostCameras = 255;

}  // namespace elbowroom::core
