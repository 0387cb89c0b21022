// Infinity: what has no nearest, no largest, no end.
#pragma once

#include <limits>

namespace elbowroom::core {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

}  // namespace elbowroom::core
