// Where a scale ends.
#pragma once

namespace elbowroom::control {

// 1, 2 or 5 times a power of ten, the least that isn't below `value`; 0 for 0. `value`: 0 or more.
[[nodiscard]] double RoundedUp(double value);

}  // namespace elbowroom::control
