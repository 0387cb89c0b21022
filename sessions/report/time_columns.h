// What happened to a part over time, gathered in columns of equal width: as many as a chart can show, however
// long the session is.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace elbowroom::sessions {

inline constexpr std::size_t kMostColumns = 1000;

struct PartColumn {
  std::optional<double> deepest_mm;        // nothing: no contact here
  std::optional<double> closest_lower_mm;  // bounds of the closest approach; nothing: none was asked
  double closest_upper_mm = 0.0;
};

// A stretch of columns.
struct ColumnRange {
  std::size_t first = 0;
  std::size_t end = 0;
};

// Columns over [begin_s, end_s], end_s > begin_s: one a frame where these are few.
struct TimeColumns {
  double begin_s = 0.0;
  double end_s = 1.0;
  std::size_t count = 1;

  [[nodiscard]] double width_s() const { return (end_s - begin_s) / static_cast<double>(count); }
  [[nodiscard]] double BeginOf(std::size_t column) const {
    return begin_s + width_s() * static_cast<double>(column);
  }
  // Of a frame that lasts from from_s to to_s: at least one column, within the others.
  [[nodiscard]] ColumnRange Of(double from_s, double to_s) const;
};

}  // namespace elbowroom::sessions
