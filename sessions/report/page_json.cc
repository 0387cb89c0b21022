#include "sessions/report/page_json.h"

namespace elbowroom::sessions {

std::string WithoutTags(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return json;
}

}  // namespace elbowroom::sessions
