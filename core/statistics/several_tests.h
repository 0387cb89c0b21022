// What p means where several questions are asked of the same people.
#pragma once

#include <span>
#include <vector>

namespace elbowroom::core {

// Holm's step-down correction: below a level for a test, the chance that any of these tests finds a
// difference where none is stays below that level, however they depend on each other. In the order of the
// tests; each in [0, 1]. Source: S. Holm, "A simple sequentially rejective multiple test procedure",
// Scandinavian Journal of Statistics 6, 1979.
[[nodiscard]] std::vector<double> CorrectForSeveral(std::span<const double> p);

}  // namespace elbowroom::core
