// What the lines of a report's tables are made of.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace elbowroom::sessions {

// RFC 4180: in quotes where the text needs them. What a spreadsheet would take for a formula (a text, or what
// follows a separator or quote in it, that begins with = + - @, tab or a line's end) gets an apostrophe
// before it, as OWASP's "CSV Injection" has it: for texts, not for numbers.
[[nodiscard]] std::string Quoted(std::string_view text);

// ",x,y,z"; nothing: ",,,".
void AppendVector(std::string& line, const std::optional<Eigen::Vector3d>& vector);

}  // namespace elbowroom::sessions
