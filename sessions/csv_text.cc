#include "sessions/csv_text.h"

#include <fmt/format.h>

namespace elbowroom::sessions {

std::string Quoted(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

void AppendVector(std::string& line, const std::optional<Eigen::Vector3d>& vector) {
  line += vector ? fmt::format(",{},{},{}", vector->x(), vector->y(), vector->z()) : ",,,";
}

}  // namespace elbowroom::sessions
