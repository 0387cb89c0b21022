#include "sessions/row_rules.h"

#include <fmt/format.h>

#include <cmath>

#include "core/file_limits.h"
#include "core/findings/finding.h"
#include "core/rigid_transform.h"
#include "sessions/database/damage.h"

namespace elbowroom::sessions {

std::size_t IndexBelow(std::int64_t index, std::size_t count, const std::string& where,
                       std::string_view what) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= count)
    FailAsDamaged(where, fmt::format("there is no {} {}", what, index));
  return static_cast<std::size_t>(index);
}

void RequireInTurn(std::int64_t index, std::size_t position, const std::string& where,
                   std::string_view what) {
  if (index < 0 || static_cast<std::uint64_t>(index) != position)
    FailAsDamaged(where,
                  fmt::format("rows are missing: {} {} comes where {} belongs", what, index, position));
}

std::int64_t CountFrom(std::int64_t least, std::int64_t number, const std::string& where,
                       std::string_view what) {
  if (number < least) FailAsDamaged(where, fmt::format("{} is {}, less than {}", what, number, least));
  return number;
}

double GapMm(double length_mm, const std::string& where, std::string_view what) {
  if (!(std::abs(length_mm) <= core::kLongestLengthMm))
    FailAsDamaged(where, fmt::format("{} is {:.6g} mm, which no gap is", what, length_mm));
  return length_mm;
}

std::string Id(std::string text, const std::string& where, std::string_view what) {
  if (!core::IsId(text))
    FailAsDamaged(where, fmt::format("{} is '{}', where 32 hexadecimal digits belong", what, Quotable(text)));
  return text;
}

double Magnitude(double value, const std::string& where, std::string_view what) {
  if (!(value >= 0.0 && value <= core::kLongestLengthMm * core::kLongestLengthMm))
    FailAsDamaged(where, fmt::format("{} is {:.6g}", what, value));
  return value;
}

double Time_s(double time_s, const std::string& where, std::string_view what) {
  if (!(std::abs(time_s) <= kLongestTime_s))
    FailAsDamaged(where, fmt::format("{} is {:.6g} s, which is no time of a trial", what, time_s));
  return time_s;
}

Eigen::Vector3d Position(const Eigen::Vector3d& x_mm, const std::string& where, std::string_view what) {
  if (!(x_mm.cwiseAbs().maxCoeff() <= core::kLongestLengthMm))
    FailAsDamaged(where, fmt::format("{} is nowhere near a trial", what));
  return x_mm;
}

Eigen::Matrix3d Rotation(const Eigen::Matrix3d& matrix, const std::string& where, std::string_view what) {
  if (!matrix.allFinite() || !core::IsRotation(matrix))
    FailAsDamaged(where, fmt::format("{} is no rotation", what));
  return matrix;
}

}  // namespace elbowroom::sessions
