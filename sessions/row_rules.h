// What the rows of a session must hold before their values are handed on.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace elbowroom::sessions {

// No time of a trial comes near this, as no length comes near core::kLongestLengthMm; what is drawn over an
// axis must stay within them.
inline constexpr double kLongestTime_s = 1e9;

// All throw Error{kFormat} that names `where` (file and row) and `what` (the column, in words).

// The index, which is one of `count` things.
[[nodiscard]] std::size_t IndexBelow(std::int64_t index, std::size_t count, const std::string& where,
                                     std::string_view what);

// Rows that are numbered from 0 come without gaps: the one at `position` carries that number.
void RequireInTurn(std::int64_t index, std::size_t position, const std::string& where, std::string_view what);

// The number, which is at least `least`.
[[nodiscard]] std::int64_t CountFrom(std::int64_t least, std::int64_t number, const std::string& where,
                                     std::string_view what);

// A gap, of either sign.
[[nodiscard]] double GapMm(double length_mm, const std::string& where, std::string_view what);
// A length, an area, a depth: not negative.
[[nodiscard]] double Magnitude(double value, const std::string& where, std::string_view what);
[[nodiscard]] double Time_s(double time_s, const std::string& where, std::string_view what);
// In world, or how far something was moved there.
[[nodiscard]] Eigen::Vector3d Position(const Eigen::Vector3d& x_mm, const std::string& where,
                                       std::string_view what);
[[nodiscard]] Eigen::Matrix3d Rotation(const Eigen::Matrix3d& matrix, const std::string& where,
                                       std::string_view what);

}  // namespace elbowroom::sessions
