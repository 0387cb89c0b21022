// How far numbers may go in files that people write: what is beyond is a slip or damage.
#pragma once

#include <cstddef>

namespace elbowroom::core {

// Ten kilometres: a longer length means nothing on a table, and the sums that follow from it lose their
// digits.
inline constexpr double kLongestLengthMm = 1e7;

// A camera's number in a hull is a byte.
inline constexpr std::size_t kMostCameras = 255;

}  // namespace elbowroom::core
