// Whether two measures of the same people go together.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace elbowroom::core {

struct Correlation {
  std::size_t n = 0;
  double r = 0.0;  // Pearson's, -1 to 1
  double p = 1.0;  // of an |r| as large, if the measures are independent and normally distributed; both tails
};

// t = r sqrt((n - 2) / (1 - r^2)) with n - 2 degrees of freedom. Nothing for fewer than three people, or
// where a measure doesn't vary. Throws: PreconditionError when the counts differ.
[[nodiscard]] std::optional<Correlation> Correlate(std::span<const double> a, std::span<const double> b);

}  // namespace elbowroom::core
