#include "sessions/report/time_columns.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::sessions {

ColumnRange TimeColumns::Of(double from_s, double to_s) const {
  constexpr double kRounding =
      1e-6;  // of a column: a frame that ends where the next begins isn't in its column
  const auto place = [&](double time_s) { return (time_s - begin_s) / width_s(); };
  const auto within = [&](double column) {
    return static_cast<std::size_t>(std::clamp(column, 0.0, static_cast<double>(count - 1)));
  };
  const std::size_t first = within(std::floor(place(from_s) + kRounding));
  const std::size_t last = within(std::ceil(place(to_s) - kRounding) - 1.0);
  return {first, std::max(first, last) + 1};
}

}  // namespace elbowroom::sessions
