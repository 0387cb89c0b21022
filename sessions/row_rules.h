// What the rows of a session must hold before their values are handed on.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace elbowroom::sessions {

// No time of a trial comes near this limit, just as no length comes near core::kLongestLengthMm. The axes of
// charts need values within these limits.
inline constexpr double kLongestTime_s = 1e9;

// All throw Error{kFormat} that names `where` (file and row) and `what` (the column, in words).

// The index. Fails unless 0 <= index < count.
[[nodiscard]] std::size_t IndexBelow(std::int64_t index, std::size_t count, const std::string& where,
                                     std::string_view what);

// Rows are numbered from 0 without gaps: fails unless the row at `position` has that number.
void RequireInTurn(std::int64_t index, std::size_t position, const std::string& where, std::string_view what);

// The number. Fails if it is below `least`.
[[nodiscard]] std::int64_t CountFrom(std::int64_t least, std::int64_t number, const std::string& where,
                                     std::string_view what);

// The id of a finding or remark (core::IsId).
[[nodiscard]] std::string Id(std::string text, const std::string& where, std::string_view what);

// A gap of either sign, core::kLongestLengthMm at most.
[[nodiscard]] double GapMm(double length_mm, const std::string& where, std::string_view what);
// A length, an area or a depth: from 0 to the square of core::kLongestLengthMm.
[[nodiscard]] double Magnitude(double value, const std::string& where, std::string_view what);
[[nodiscard]] double Time_s(double time_s, const std::string& where, std::string_view what);
// A position in world, or a translation there: each coordinate is core::kLongestLengthMm at most.
[[nodiscard]] Eigen::Vector3d Position(const Eigen::Vector3d& x_mm, const std::string& where,
                                       std::string_view what);
[[nodiscard]] Eigen::Matrix3d Rotation(const Eigen::Matrix3d& matrix, const std::string& where,
                                       std::string_view what);

}  // namespace elbowroom::sessions
