// Fields of the lines of CSV tables.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace elbowroom::sessions {

// The text as a CSV field (RFC 4180), in quotes where it needs them. An apostrophe is put before whatever a
// spreadsheet would take for a formula (a text, or what follows a separator or quote in it, that begins with
// = + - @; a text that begins with a tab or a line's end), as OWASP's "CSV Injection" recommends. For texts,
// not for numbers.
[[nodiscard]] std::string Quoted(std::string_view text);

// ",x,y,z"; nothing: ",,,".
void AppendVector(std::string& line, const std::optional<Eigen::Vector3d>& vector);

}  // namespace elbowroom::sessions
