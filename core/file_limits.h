// Limits for numbers in files that people write. A number beyond them is a mistake or damage.
#pragma once

#include <cstddef>

namespace elbowroom::core {

// A thousand kilometres. No length on a table is larger.
inline constexpr double kLongestLengthMm = 1e9;

// A camera's number is kept in a byte (recon/hull_mesh).
inline constexpr std::size_t kMostCameras = 255;

}  // namespace elbowroom::core
