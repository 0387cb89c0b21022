// What the lines of a report's tables are made of.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace elbowroom::sessions {

// RFC 4180: in quotes where the text needs them.
[[nodiscard]] std::string Quoted(std::string_view text);

// ",x,y,z"; nothing: ",,,".
void AppendVector(std::string& line, const std::optional<Eigen::Vector3d>& vector);

}  // namespace elbowroom::sessions
